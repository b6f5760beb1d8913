// Reflection by a film of water, and how the film darkens the ground below it. The f64 reference is
// src/ground/reference.rs.

// Refractive index of water relative to air, for visible light at 20 C (Hale & Querry 1973, rounded).
const WATER_INDEX: f32 = 1.333;
// Share of diffuse light from above that a level water surface reflects (Fresnel's law integrated over the hemisphere).
const WATER_OUTSIDE: f32 = 0.0664;
// Share of diffuse light from below that the surface reflects.
const WATER_INSIDE: f32 = 0.4746;

// Returns the share of unpolarised light that water reflects at an angle of incidence with this cosine (Fresnel 1823,
// in the form of Cook & Torrance 1982, eq. 18).
fn fresnel_water(cosine: f32) -> f32 {
    let c = clamp(cosine, 0.0, 1.0);
    let g = sqrt(WATER_INDEX * WATER_INDEX - 1.0 + c * c);
    let a = (g - c) / (g + c);
    let b = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
    return 0.5 * a * a * (1.0 + b * b);
}

// Returns the factor by which a film dims the light that a rough ground of this albedo sends up. Light in the film is
// reflected at the surface from below and falls on the ground again (Angstrom 1925; Lekner & Dorf 1988, eq. 1 to 3).
// `entering` is the share of the light from above that enters the water.
fn wet_share(albedo: vec3f, entering: f32) -> vec3f {
    return entering * (1.0 - WATER_INSIDE) / (1.0 - WATER_INSIDE * clamp(albedo, vec3f(0.0), vec3f(1.0)));
}

// Returns the mean slope, towards the eye, of the facets that the eye sees on a rough surface. `slope` is the root mean
// square slope along one axis, normally distributed; `tangent` is the tangent of the eye's zenith angle. For steep
// views the mean is slope^2 tangent; for grazing views it is sqrt(pi / 2) slope, the mean of the facets that face the
// eye, weighted by their own slope.
fn seen_slope(slope: f32, tangent: f32) -> f32 {
    let t = slope * tangent * 0.797884561;
    return slope * slope * tangent / sqrt(1.0 + t * t);
}

// Returns the projected area of a unit of rough surface in a direction with this zenith cosine: sqrt(c^2 + (0.4
// slope)^2 (1 - c^2)). The second term is that of tilted facets at grazing views.
fn seen_area(slope: f32, cosine: f32) -> f32 {
    let c = max(cosine, 0.0);
    return sqrt(c * c + 0.16 * slope * slope * (1.0 - c * c));
}

// Returns the luminance of the glitter of a lamp of illuminance 1 on rough water, divided by the Fresnel share (Cox &
// Munk 1954, eq. 5, with the shadowing of facets by each other). `up` is the surface's normal, `facet` the normal of
// the facet that reflects the lamp's centre into the eye.
// The lamp's disc, `disc2` = (radius / 4)^2, adds to the variance of the slopes. To reflect the edge of the disc
// instead of its centre, a facet must turn by half the radius along the view direction, and by more across it.
fn glitter(slope: f32, disc2: f32, up: vec3f, facet: vec3f, to_eye: vec3f, to_lamp: vec3f) -> f32 {
    let c = dot(up, facet);
    let lit = dot(up, to_lamp);
    let seen = dot(up, to_eye);
    // Calm water has no visible area from its own level or from below.
    let area = seen_area(slope, seen) * seen_area(slope, lit);
    if c <= 0.0 || lit <= 0.0 || area <= 1e-6 {
        return 0.0;
    }
    let tilt = facet / c - up;
    let level = to_eye - up * seen;
    let toward = dot(tilt, level) * inverseSqrt(max(dot(level, level), 1e-12));
    let along = toward * toward;
    let across = max(dot(tilt, tilt) - along, 0.0);
    let opening = max(dot(facet, to_eye), 1e-3);
    let s2 = vec2f(disc2, disc2 / (opening * opening)) + slope * slope;
    let density = exp(-min(0.5 * (along / s2.x + across / s2.y), 80.0)) * inverseSqrt(s2.x * s2.y) / (6.28318531 * c * c * c * c);
    return density * lit / (4.0 * area);
}
