// Mueller matrices of scene files and of measurements.
#pragma once
#include <array>
#include <string>

namespace etendue {

// Rows first.
using MuellerMatrix = std::array<double, 16>;

// Empty, or why no sheet has such a matrix: it makes light of light, or (an eigenvalue of its coherency
// matrix being negative) more polarization than there is light (Cloude 1990).
std::string flaw_of(const MuellerMatrix& m);

// A measured matrix without what noise has made of it: more polarization than light. Negative eigenvalues of
// the coherency matrix are dropped, and the others scaled so that the first element, which is not negative,
// stays (Cloude 1990). Physical matrices stay as they are, but for 1e-6 of the first element.
MuellerMatrix without_excess(const MuellerMatrix& m);

}  // namespace etendue
