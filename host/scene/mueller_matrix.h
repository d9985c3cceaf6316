// Mueller matrices of scene files.
#pragma once
#include <array>
#include <string>

namespace etendue {

// Rows first.
using MuellerMatrix = std::array<double, 16>;

// Empty, or why no sheet has such a matrix: it makes light of light, or (an eigenvalue of its coherency
// matrix being negative) more polarization than there is light (Cloude 1990).
std::string flaw_of(const MuellerMatrix& m);

}  // namespace etendue
