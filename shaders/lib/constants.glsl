// Numbers that every shader shares.
const float PI = 3.14159265358979;
const float INV_PI = 0.318309886183791;
const float INFINITY = 1e30;  // a distance that no scene reaches; finite, so that 0 * INFINITY stays 0
const float EPSILON = 5.9604645e-8;  // 2^-24, half a unit in the last place of 1

// gamma(n): relative error bound of n rounded operations, n eps / (1 - n eps) (Higham 2002, pbrt 4ed. 6.8.1).
float gamma(float n) { return n * EPSILON / (1.0 - n * EPSILON); }

float square(float x) { return x * x; }
