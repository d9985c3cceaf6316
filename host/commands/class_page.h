// A manual of classes as one page of HTML that needs no other file.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "host/commands/showcases.h"
#include "host/scene/classes.h"

namespace etendue {

// `classes`: reflected, those of an interface one after the other. `pictures`: of those that have one.
std::string class_page(const ClassRegistry& registry, const std::vector<const ClassInfo*>& classes,
                       const std::map<const ClassInfo*, Png>& pictures);

}  // namespace etendue
