// Octahedral map of all directions to a square: the lower half is folded out over the corners (Cigolle et al. 2014).

// Position of a direction in the square, 0 to 1.
fn octahedron_place(d: vec3f) -> vec2f {
    let p = d.xy / (abs(d.x) + abs(d.y) + abs(d.z));
    let folded = (1.0 - abs(p.yx)) * select(vec2f(-1.0), vec2f(1.0), p >= vec2f(0.0));
    return 0.5 + 0.5 * select(folded, p, d.z >= 0.0);
}

// Unit vector of a position in the square.
fn octahedron_direction(place: vec2f) -> vec3f {
    let p = place * 2.0 - 1.0;
    let z = 1.0 - abs(p.x) - abs(p.y);
    let folded = (1.0 - abs(p.yx)) * select(vec2f(-1.0), vec2f(1.0), p >= vec2f(0.0));
    return normalize(vec3f(select(folded, p, z >= 0.0), z));
}
