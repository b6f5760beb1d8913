// Version of guarded.wgsl for builds with debug assertions: an infinite value or a NaN passes all limits. A float
// picture then holds a NaN, and reading the picture back fails; other pictures are magenta in that pixel.

// Whether no channel is infinite or a NaN.
fn is_finite(v: vec3f) -> bool {
    // Compilers may assume that there is no NaN; a test of the bits is safe from that.
    return all((bitcast<vec3u>(v) & vec3u(0x7f800000u)) != vec3u(0x7f800000u));
}

// NaN in each channel.
fn no_number(v: vec3f) -> vec3f {
    return bitcast<vec3f>(bitcast<vec3u>(v) | vec3u(0x7fc00000u));
}

// Unit vector along `v`, or along `other` if `v` is zero; a NaN passes.
fn unit_or(v: vec3f, other: vec3f) -> vec3f {
    return normalize(select(other, v, dot(v, v) > 0.0));
}

// Limits `v` to the greatest value that a pass's target holds; what is not finite becomes a NaN.
fn capped(v: vec3f, most: f32) -> vec3f {
    return select(no_number(v), min(v, vec3f(most)), is_finite(v));
}

// Limits `v` to 0 and more; what is not finite becomes a NaN.
fn not_negative(v: vec3f) -> vec3f {
    return select(no_number(v), max(v, vec3f(0.0)), is_finite(v));
}

// Returns `shown`, the picture's value for `light`, or a mark where the light is not finite.
fn marked(shown: vec3f, light: vec3f, is_float: bool) -> vec3f {
    let mark = select(vec3f(1.0, 0.0, 1.0), no_number(light), is_float);
    return select(mark, shown, is_finite(light));
}
