// Optical elements: scenes of their own, each with its frame and its hierarchy, that the scene knows the boundary of and nothing
// else. Rays are in the scene or in one of the elements, which hold others to any depth; where they are is state of theirs, one
// word, and positions and directions are those of its frame (features/boundaries.glsl moves them from one to the other).
//
// Of an element's boundary each of the two hierarchies holds a copy, whose triangles face outward. In that of its parent a ray
// that comes from outside enters; one that comes from inside has started there, at a surface that touches the boundary, and is in
// the element already. In its own a ray that comes from inside leaves. The copy that a ray has just come through does not count.
#include "features/defaults.glsl"
#include "lib/constants.glsl"
#include "lib/records.glsl"

const uint NOT_IN_ELEMENT = 0u;  // a location: in the scene

#if HAS_ELEMENTS
// Twin: struct ElementRecord of host/scene/scene_elements.cpp. elements[0] is the scene.
struct Element {
    mat4x3 parent_from_local, local_from_parent;  // turned and moved, not scaled
    uint parent;
    uint header;                      // of its tree (lib/bvh.glsl)
    uint first_light, light_count;    // in the list of lights
};
layout(scalar) readonly buffer Elements { Element elements[]; };

// A location is the element, or with JUST_LEFT the one that the ray has come out of last; with LEFT_BY_CHANCE it has missed the
// boundary, by rounding, and must not meet it again.
const uint JUST_LEFT = 0x80000000u;
const uint LEFT_BY_CHANCE = 0x40000000u;
const uint LEFT_INDEX = 0x3FFFFFFFu;
const uint OWN_BOUNDARY = 0u;  // for the element that a boundary leads to: out of the one that holds it

uint ray_location = NOT_IN_ELEMENT;  // of the ray that is traced next
#define locate_ray(location) ray_location = (location)

uint element_at(uint location) {
    if ((location & JUST_LEFT) != 0u) return elements[location & LEFT_INDEX].parent;
    return location;
}
#define element_of(path) element_at(path.location)
#define start_location(path, element) path.location = (element)
#define within_element(path) (element_at(path.location) != NOT_IN_ELEMENT)
#define same_element(path, view) (element_at(path.location) == view.element)
#define locate_shadow(shadow, path) shadow.location = element_at(path.location)
// At an event.
#define settle(path) path.location = element_at(path.location)

#define location_bits(path) uintBitsToFloat(path.location)
#define tree_header() elements[element_at(ray_location)].header

#define parent_of(element) elements[element].parent
// A point, or with w = 0 a direction, of an element's frame in that of the scene.
vec3 in_scene(uint element, vec3 v, float w) {
    while (element != NOT_IN_ELEMENT) {
        v = elements[element].parent_from_local * vec4(v, w);
        element = elements[element].parent;
    }
    return v;
}

// Lights within elements follow those of the scene in the list.
layout(scalar, set = 0) readonly buffer LightElements { uint light_elements[]; };
#define location_of_light(light) light_elements[light]
#else
#define locate_ray(location)
#define element_of(path) NOT_IN_ELEMENT
#define start_location(path, element)
#define within_element(path) false
#define same_element(path, view) true
#define locate_shadow(shadow, path)
#define settle(path)
#define location_bits(path) 0.0
#define parent_of(element) NOT_IN_ELEMENT
#define in_scene(element, v, w) (v)
#define tree_header() WORLD_HEADER
#endif
