// What rough surfaces of single-scattering GGX facets lose (lib/microfacet.glsl: Smith, G1 G1), for the lobes
// that give it back. The functions are fits to quadratures of the albedo over 256 x 128 visible facets.
#include "lib/accurate_math.glsl"

// 1 - E(mu) of facets that reflect everything, to 0.002, for mu > 0, alpha in [1e-4, 1].
float ggx_loss(float mu, float alpha) {
    float s = mu * inversesqrt(mu * mu + 9.0 * alpha * alpha);
    float a = alpha;
    float p = 0.6155 + a * (5.0557 + a * (-4.5357 + a * 3.4828));
    p = -1.1523 + a * (-5.1675 + a * (3.1920 + a * 7.2468)) + s * p;
    p = 0.2194 + a * (1.7600 + a * (0.5171 + a * -5.0812)) + s * p;
    p = 0.3794 + a * (-0.5153 + a * (3.1108 + a * -0.7169)) + s * p;
    p = 0.0628 + a * (0.0427 + a * (0.5361 + a * -0.2572)) + s * p;
    return max((1.0 - s) * p, 0.0);
}

// 2 ∫ ggx_loss(mu, alpha) mu dmu.
float ggx_average_loss(float alpha) {
    float a = alpha, l = log(alpha);
    return a * a * (0.243 - 1.02644 * l + a * (-1.90449 - 1.65972 * l + a * (3.0585 - a * 0.77449)));
}

// Directions for such a lobe. The losses of all these surfaces fall about as 1 / (mu² + 4 alpha²), so a cosine
// would miss the grazing directions where narrow lobes lose most: light that goes round inside a sphere meets
// them again and again. Density mu / (pi (mu² + w²) ln(1 + 1/w²)) with w = 2 alpha, 1/sr.
float ggx_multiscatter_pdf(float mu, float alpha) {
    float w2 = 4.0 * alpha * alpha;
    return mu * INV_PI / ((mu * mu + w2) * log(1.0 + 1.0 / w2));
}

vec3 ggx_sample_multiscatter(vec2 u, float alpha) {
    float w2 = 4.0 * alpha * alpha;
    float mu2 = clamp(w2 * (exp(u.x * log(1.0 + 1.0 / w2)) - 1.0), 0.0, 1.0);
    return vec3(sqrt(1.0 - mu2) * cos_sin_turns(u.y), sqrt(mu2));
}

// Part of the samples that follow it: what is lost, but never so much that the others weigh more than twice.
float ggx_multiscatter_part(float loss) { return clamp(loss, 0.0, 0.5); }

// The same for dielectric facets that reflect and refract: the part of the light from mu that neither leaves
// above nor below. Small networks of one hidden layer, y = z / sqrt(1 + z²), trained for indices 1.2 to 2.4
// (beyond, the nearest of these is taken): at index 1.5 the sum of both lobes is 1 within 0.003, for alpha
// below 0.05 within 0.015 at grazing angles, and its mean within 0.001; towards 1.2 and 2.4 within 0.05 at grazing
// angles, in the mean within 0.005.
float ggx_dielectric_loss(float mu, float alpha, float eta) {
    float inv_index = clamp(min(eta, 1.0 / eta), 1.0 / 2.4, 1.0 / 1.2);
    float width = alpha * (eta > 1.0 ? 1.0 : 0.7);
    vec4 x = vec4(mu * inversesqrt(mu * mu + width * width), max(alpha, 1e-3), inv_index, mu);
    vec4 z;
    float sum;
    if (eta > 1.0) {
        sum = 0.27450;
        z = vec4(0.7242, -1.9887, 7.1785, 0.5083) * x.x + vec4(0.8319, -0.4019, 0.1355, 2.0441) * x.y +
            vec4(-2.1292, 3.1870, -0.0171, 0.3442) * x.z + vec4(0.1320, -0.7542, -2.0458, 0.9746) * x.w +
            vec4(-1.2615, -3.3226, -7.5242, -0.9086);
        sum += dot(vec4(-0.34961, -0.85529, 0.23642, -0.22922), z * inversesqrt(1.0 + z * z));
        z = vec4(1.2777, -0.2867, -0.8380, 3.5715) * x.x + vec4(3.0116, -0.7121, -3.1827, 7.3834) * x.y +
            vec4(-0.0314, 1.9879, -0.4943, -2.0438) * x.z + vec4(0.4591, 1.0367, -0.9149, 4.2325) * x.w +
            vec4(-0.5206, -0.8548, 0.4945, 1.8326);
        sum += dot(vec4(-0.40918, 0.13213, -0.69124, 0.50734), z * inversesqrt(1.0 + z * z));
        z = vec4(2.5335, -0.3409, -1.5216, 0.3055) * x.x + vec4(3.5748, -1.4833, 1.1000, 2.2459) * x.y +
            vec4(-2.0290, -0.1638, 1.4740, 1.4424) * x.z + vec4(0.1650, 1.6775, 0.2180, 0.6171) * x.w +
            vec4(2.0641, 0.7255, -1.8902, -1.3499);
        sum += dot(vec4(-1.72512, 0.13948, 0.59109, 0.58268), z * inversesqrt(1.0 + z * z));
        z = vec4(0.4391, -0.0271, -1.2832, -0.5107) * x.x + vec4(-0.4452, -1.5374, 0.8489, -0.9640) * x.y +
            vec4(0.6567, -1.6395, 1.4699, -1.8756) * x.z + vec4(-0.0516, -0.5709, 0.0771, -0.0026) * x.w +
            vec4(-2.0035, 1.0241, -1.7407, 3.3107);
        sum += dot(vec4(-0.96059, 0.70292, -1.03733, -0.47333), z * inversesqrt(1.0 + z * z));
    } else {
        sum = 2.81591;
        z = vec4(-0.5456, -0.7486, -1.3801, -1.1868) * x.x + vec4(-0.9360, -0.4323, -1.7545, 1.9117) * x.y +
            vec4(-1.4627, -5.2758, -0.8093, 4.1347) * x.z + vec4(-0.4401, 6.1854, 0.5376, 3.2682) * x.w +
            vec4(1.9752, 0.9621, 0.2493, -3.7724);
        sum += dot(vec4(1.44138, 0.04392, -0.44847, -0.07609), z * inversesqrt(1.0 + z * z));
        z = vec4(-0.4343, 1.0148, -0.1063, -1.2398) * x.x + vec4(1.0928, 2.4810, 0.4016, 2.4676) * x.y +
            vec4(1.0990, -3.4918, 0.0476, -3.0680) * x.z + vec4(1.7119, -2.4019, -0.1002, 0.1685) * x.w +
            vec4(-0.2982, -1.0764, 0.0796, -1.2705);
        sum += dot(vec4(1.41419, -0.85572, -6.22391, 0.66692), z * inversesqrt(1.0 + z * z));
        z = vec4(5.6696, 0.9835, 0.4604, 9.2705) * x.x + vec4(-2.0121, 1.3844, -0.0820, -0.7387) * x.y +
            vec4(-0.4956, -0.6732, -1.3403, -0.1417) * x.z + vec4(0.4512, -0.4505, 0.2153, 0.6961) * x.w +
            vec4(-5.5750, -0.7932, 0.9714, -10.1459);
        sum += dot(vec4(-0.39145, -3.34025, -1.70807, 1.40087), z * inversesqrt(1.0 + z * z));
        z = vec4(-0.0625, -0.1151, -0.2179, 0.5048) * x.x + vec4(-0.4813, 0.0588, 0.8238, 0.4217) * x.y +
            vec4(-0.7695, 1.0753, 2.2165, 1.8443) * x.z + vec4(-1.4678, -1.9304, 0.9564, -2.5339) * x.w +
            vec4(0.5166, -0.6990, -1.8351, -0.8196);
        sum += dot(vec4(3.01544, -0.93219, 0.64889, -0.83016), z * inversesqrt(1.0 + z * z));
        z = vec4(0.5162, -0.0651, 0.7446, 1.1806) * x.x + vec4(0.3497, 0.2354, 1.1363, 2.0517) * x.y +
            vec4(2.0309, 1.2405, -0.2895, -3.8913) * x.z + vec4(-2.6901, -1.5117, -0.1685, -2.8982) * x.w +
            vec4(0.0456, 0.0007, -0.8483, 2.3588);
        sum += dot(vec4(-0.58565, 2.16466, 6.80183, 0.05731), z * inversesqrt(1.0 + z * z));
    }
    return clamp(1.0 - sum, 5e-4, 1.0);
}

// 2 ∫ ggx_dielectric_loss(mu, alpha, eta) mu dmu for eta and for 1 / eta: logarithms are polynomials in alpha^(1/4) and the index.
vec2 ggx_dielectric_average_losses(float alpha, float eta) {
    float v = 2.0 * sqrt(sqrt(max(alpha, 1e-3))) - 1.3;
    float u = 4.0 * clamp(min(eta, 1.0 / eta), 1.0 / 2.4, 1.0 / 1.2) - 2.52;
    float denser, thinner;  // what lies behind the surface
    denser = -5.652 + u * (3.798 + u * (-5.564 + u * (-0.545 + u * -1.762)));
    denser = -0.177 + u * (0.002 + u * (6.250 + u * (4.329 + u * 0.133))) + v * denser;
    denser = 9.823 + u * (-5.463 + u * (5.654 + u * (-2.414 + u * 3.692))) + v * denser;
    denser = -2.476 + u * (0.871 + u * (-9.132 + u * (-4.607 + u * -0.136))) + v * denser;
    denser = -4.517 + u * (2.096 + u * (0.272 + u * (4.242 + u * -2.465))) + v * denser;
    denser = 1.130 + u * (-0.785 + u * (3.812 + u * (0.476 + u * -0.370))) + v * denser;
    denser = -0.206 + u * (0.197 + u * (-1.882 + u * (-1.792 + u * 1.406))) + v * denser;
    denser = 4.296 + u * (-0.167 + u * (0.163 + u * (0.741 + u * -0.428))) + v * denser;
    denser = -3.956 + u * (-0.128 + u * (0.164 + u * (-0.085 + u * 0.005))) + v * denser;
    thinner = -11.627 + u * (12.761 + u * (-30.515 + u * (-21.897 + u * 55.378)));
    thinner = 0.504 + u * (-2.294 + u * (22.459 + u * (-7.883 + u * -30.105))) + v * thinner;
    thinner = 18.190 + u * (-18.250 + u * (24.601 + u * (36.073 + u * -56.662))) + v * thinner;
    thinner = -6.180 + u * (6.896 + u * (-24.533 + u * (0.929 + u * 37.470))) + v * thinner;
    thinner = -5.594 + u * (6.040 + u * (2.328 + u * (-16.757 + u * 8.780))) + v * thinner;
    thinner = 3.421 + u * (-2.740 + u * (2.407 + u * (3.084 + u * -7.536))) + v * thinner;
    thinner = -3.234 + u * (-0.313 + u * (-0.170 + u * (1.253 + u * -0.492))) + v * thinner;
    thinner = 4.562 + u * (-0.252 + u * (-0.394 + u * (-0.129 + u * 0.636))) + v * thinner;
    thinner = -2.467 + u * (0.081 + u * (-0.029 + u * (-0.107 + u * -0.081))) + v * thinner;
    return exp(eta > 1.0 ? vec2(denser, thinner) : vec2(thinner, denser));
}

// Part of the multiply scattered light that is transmitted, seen from the side where the index ratio is eta, and from the other
// (Kulla & Conty 2017): x (1 - F_avg), with x = loss_far / (loss_near + loss_far) so that
// n² loss T is the same from both sides, which makes the lobes reciprocal. F_avg is their fit for eta >= 1;
// the other side's follows from n² (1 - F_avg) being the same.
vec2 ggx_dielectric_multiscatter_transmissions(vec2 average_losses, float eta) {
    float index = max(eta, 1.0 / eta);
    float through = 1.0 - (index - 1.0) / (4.08567 + 1.00071 * index);
    vec2 sides = through * (eta < 1.0 ? vec2(eta * eta, 1.0) : vec2(1.0, 1.0 / (eta * eta)));
    return sides * average_losses.yx / (average_losses.x + average_losses.y);
}
