// The sheen of cloth: the Charlie distribution of fibres (Estevez & Kulla 2017, "Production Friendly Microfacet Sheen
// BRDF"), whose width is alpha = roughness² as in KHR_materials_sheen. Directions are local with z > 0.

// Narrower ones are taken as this wide: the lobe is then a rim of 8 degrees.
const float SHEEN_LEAST_ROUGHNESS = 0.1;

// The fit of their section 3 to the integral for shadowing and masking.
float sheen_lambda(float mu, float alpha) {
    float narrow = square(1.0 - alpha);
    float a = mix(21.5473, 25.3245, narrow), b = mix(3.82987, 3.32435, narrow), c = mix(0.19823, 0.16801, narrow);
    float d = mix(-1.97760, -1.27393, narrow), e = mix(-4.32054, -4.85967, narrow);
    float at = mu < 0.5 ? mu : 1.0 - mu;
    float l = a / (1.0 + b * pow(max(at, 1e-7), c)) + d * at + e;
    float middle = a / (1.0 + b * pow(0.5, c)) + d * 0.5 + e;
    return exp(mu < 0.5 ? l : 2.0 * middle - l);
}

// Not less than the albedo of the lobe before it is scaled, and less than 0.07 above it for mu > 0.01: a fit to
// quadratures of 160 x 200 points, from above. Above one for narrow lobes near the horizon.
float sheen_bound(float mu, float roughness) {
    float r = max(roughness, SHEEN_LEAST_ROUGHNESS), s = sqrt(max(mu, 0.0));
    float p = -32.3921 + r * (157.2808 + r * (-355.9016 + r * (367.0404 - r * 137.5165)));
    p = 47.1797 + r * (-230.3116 + r * (518.7451 + r * (-521.8842 + r * 188.6622))) + s * p;
    p = -30.2647 + r * (115.5478 + r * (-199.6039 + r * (149.1066 - r * 36.7285))) + s * p;
    p = -2.1008 + r * (26.0655 + r * (-87.4373 + r * (112.0343 - r * 49.4037))) + s * p;
    p = 1.9318 + r * (-13.5307 + r * (31.0721 + r * (-30.0143 + r * 10.6150))) + s * p;
    return exp(p);
}

// The same of the lobe below: at most one.
float sheen_albedo_bound(float mu, float roughness) { return min(sheen_bound(mu, roughness), 1.0); }

// f |cos wi| of white sheen, 1/sr: D / (4 wo.z (1 + lambda(wo) + lambda(wi))), scaled where the fit of lambda would let it
// send out more than it gets.
float sheen_reflection(vec3 wo, vec3 wi, float roughness) {
    float alpha = square(max(roughness, SHEEN_LEAST_ROUGHNESS));
    vec3 h = wo + wi;
    float sine2 = dot(h.xy, h.xy) / max(dot(h, h), 1e-14);
    float d = (2.0 + 1.0 / alpha) * pow(max(sine2, 1e-14), 0.5 / alpha) * (0.5 * INV_PI);
    float scale = max(max(sheen_bound(wo.z, roughness), sheen_bound(wi.z, roughness)), 1.0);
    return d / (4.0 * max(wo.z, 1e-4) * (1.0 + sheen_lambda(wo.z, alpha) + sheen_lambda(wi.z, alpha)) * scale);
}
