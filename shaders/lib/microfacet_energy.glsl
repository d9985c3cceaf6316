// What rough surfaces of single-scattering GGX facets lose (lib/microfacet.glsl: Smith, G1 G1), for the lobes
// that give it back. The functions are fits to quadratures of the albedo over 256 x 128 visible facets.

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

// The same for dielectric facets that reflect and refract: the part of the light from mu that neither leaves
// above nor below. Small networks of one hidden layer, y = z / sqrt(1 + z²), trained for indices 1.2 to 2.4
// (beyond, the nearest of these is taken): the albedo is within 0.002 (eta > 1) and 0.005 (eta < 1).
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
        sum = 1.62449;
        z = vec4(-0.6510, 5.2378, -1.0570, -0.4345) * x.x + vec4(-0.9426, 2.4944, -2.0161, 1.3454) * x.y +
            vec4(-1.0584, -12.1691, -0.7403, 2.1116) * x.z + vec4(-0.1437, 6.4265, -2.0623, 1.6022) * x.w +
            vec4(1.6696, -0.8177, -0.0222, -1.9065);
        sum += dot(vec4(1.45344, 0.00762, -0.57428, -1.07617), z * inversesqrt(1.0 + z * z));
        z = vec4(-1.6281, 0.1926, -0.1586, -1.7468) * x.x + vec4(7.2104, 2.4884, 0.6204, 2.3157) * x.y +
            vec4(-1.4262, -4.3855, -0.2858, -4.0654) * x.z + vec4(-0.8156, -1.6572, -0.6362, 0.5415) * x.w +
            vec4(3.4957, -0.5807, 0.4222, -0.5618);
        sum += dot(vec4(0.11686, -0.86711, -3.27394, 0.74383), z * inversesqrt(1.0 + z * z));
        z = vec4(5.5148, 1.2103, 0.5001, 9.0611) * x.x + vec4(-3.0221, 1.5641, -0.0034, -1.6389) * x.y +
            vec4(0.1556, -1.1799, -1.4183, 0.1729) * x.z + vec4(0.7713, -0.5995, 0.4134, 0.7398) * x.w +
            vec4(-6.0343, -0.6401, 0.8782, -10.1223);
        sum += dot(vec4(-0.53576, -1.16318, -1.40563, 1.48457), z * inversesqrt(1.0 + z * z));
        z = vec4(-0.0993, -0.1921, -0.2875, 0.6001) * x.x + vec4(-0.2093, 0.0461, 1.2907, 0.2995) * x.y +
            vec4(-0.5127, 0.8364, 2.3262, 0.9222) * x.z + vec4(-1.7182, -2.5331, 1.3747, -1.8908) * x.w +
            vec4(0.2904, -0.4032, -1.9923, -0.3634);
        sum += dot(vec4(1.55481, -0.58714, 1.03472, -1.14640), z * inversesqrt(1.0 + z * z));
        z = vec4(-0.0017, -0.4377, 0.7878, 0.6067) * x.x + vec4(0.3223, 0.2165, 1.0986, 1.4100) * x.y +
            vec4(1.6957, 0.8949, -0.4515, -1.7997) * x.z + vec4(-2.5465, -1.3439, -0.1229, -1.8077) * x.w +
            vec4(0.8388, 0.7023, -0.7415, 1.0512);
        sum += dot(vec4(-0.44083, 2.49559, 3.71787, 0.38150), z * inversesqrt(1.0 + z * z));
    }
    return clamp(1.0 - sum, 5e-4, 1.0);
}

// 2 ∫ ggx_dielectric_loss(mu, alpha, eta) mu dmu: the logarithm is a polynomial in alpha^(1/4) and the index.
float ggx_dielectric_average_loss(float alpha, float eta) {
    float v = sqrt(sqrt(max(alpha, 1e-3))) - 0.75;
    float u = clamp(min(eta, 1.0 / eta), 1.0 / 2.4, 1.0 / 1.2) - 0.65;
    float sum;
    if (eta > 1.0) {
        sum = 102.6993 + u * (-29.8536 + u * (-2279.9879 + u * (-11632.9766)));
        sum = 10.2375 + u * (9.8241 + u * (-2044.1863 + u * (-6740.1186))) + v * sum;
        sum = -23.8788 + u * (-6.8216 + u * (110.4883 + u * (2354.5726))) + v * sum;
        sum = -5.2405 + u * (-10.3386 + u * (279.5314 + u * (813.2880))) + v * sum;
        sum = -2.9266 + u * (2.7008 + u * (-41.6065 + u * (-320.5975))) + v * sum;
        sum = 8.2779 + u * (-0.6486 + u * (-5.0527 + u * (30.6842))) + v * sum;
        sum = -3.1084 + u * (-0.5524 + u * (2.3162 + u * (-0.0789))) + v * sum;
    } else {
        sum = 630.3630 + u * (-1889.5048 + u * (-3780.1757 + u * (1099.8942)));
        sum = 598.1343 + u * (-1659.4151 + u * (-5590.6737 + u * (12554.6834))) + v * sum;
        sum = -55.4786 + u * (56.2844 + u * (-954.0479 + u * (3894.0750))) + v * sum;
        sum = -73.0359 + u * (221.2206 + u * (926.1208 + u * (-1557.8576))) + v * sum;
        sum = 11.9001 + u * (9.9386 + u * (113.4171 + u * (-24.6971))) + v * sum;
        sum = -9.5258 + u * (-6.8328 + u * (-33.6296 + u * (-33.0532))) + v * sum;
        sum = 6.6568 + u * (-3.6732 + u * (-5.7193 + u * (13.4659))) + v * sum;
        sum = -1.6634 + u * (-0.0421 + u * (-1.9521 + u * (-5.3207))) + v * sum;
    }
    return exp(sum);
}

// Part of the multiply scattered light that is transmitted, seen from the side where the index ratio is eta
// (Kulla & Conty 2017): x (1 - F_avg), with x = loss_far / (loss_near + loss_far) so that
// n² loss T is the same from both sides, which makes the lobes reciprocal. F_avg is their fit for eta >= 1;
// the other side's follows from n² (1 - F_avg) being the same.
float ggx_dielectric_multiscatter_transmission(float alpha, float eta) {
    float index = max(eta, 1.0 / eta);
    float through = 1.0 - (index - 1.0) / (4.08567 + 1.00071 * index);
    if (eta < 1.0) through *= eta * eta;
    float near = ggx_dielectric_average_loss(alpha, eta), far = ggx_dielectric_average_loss(alpha, 1.0 / eta);
    return through * far / (near + far);
}

// f |cos wi| of that light in power transport, 1/sr; mu_o > 0, mu_i < 0 where it is transmitted.
float ggx_dielectric_multiscatter(float mu_o, float mu_i, float alpha, float eta) {
    float transmitted = ggx_dielectric_multiscatter_transmission(alpha, eta);
    float eta_i = mu_i > 0.0 ? eta : 1.0 / eta;
    float losses = ggx_dielectric_loss(mu_o, alpha, eta) * ggx_dielectric_loss(abs(mu_i), alpha, eta_i);
    return (mu_i > 0.0 ? 1.0 - transmitted : transmitted) * losses * abs(mu_i) /
           (PI * ggx_dielectric_average_loss(alpha, eta_i));
}
