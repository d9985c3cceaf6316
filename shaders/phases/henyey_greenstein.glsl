// One lobe, forward or backward (Henyey & Greenstein 1941): (1 - g²) / (4 pi (1 + g² - 2 g cos)^(3/2)).
//
// Example:
//     {"extensions": {"ETD_optics": {"media": [
//         {"name": "fog", "class": "homogeneous", "scattering": 0.4, "phase": {"class": "henyey_greenstein", "g": 0.6}}]}}}
struct HenyeyGreenstein {
    float g;  //: 0 in [-0.999, 0.999]. Mean cosine of the angle by which light is turned: above 0 it goes on rather than back.
};

Spectrum henyey_greenstein_value(HenyeyGreenstein r, float cosine) {
    float turned = r.g < 0.0 ? 1.0 + cosine : 1.0 - cosine;  // 1 + g² - 2 g cos in a form that keeps its digits
    float g = abs(r.g), denominator = square(1.0 - g) + 2.0 * g * turned;
    return Spectrum(0.25 * INV_PI * (1.0 - g) * (1.0 + g) / (denominator * sqrt(denominator)));
}

// The inverse of its integral as 1 - cos = 2 (1 - g)² (1 - u) (1 + g u) / (1 - g + 2 g u)², which holds for g = 0, too.
float henyey_greenstein_sample(HenyeyGreenstein r, float u) {
    float g = abs(r.g);
    float turned = 2.0 * (1.0 - u) * (1.0 + g * u) * square((1.0 - g) / (1.0 - g + 2.0 * g * u));
    return r.g < 0.0 ? turned - 1.0 : 1.0 - turned;
}
