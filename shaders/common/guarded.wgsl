// Arithmetic with a valid result for every operand, and limits for light on its way to a picture. The limits can hide
// a NaN: `max` may turn it into 0, and `min` into the greatest value. Builds with debug assertions use
// guarded_checked.wgsl instead, which shows where a NaN is.

// Unit vector along `v`, or along `other` if `v` is zero.
fn unit_or(v: vec3f, other: vec3f) -> vec3f {
    return normalize(select(other, v, dot(v, v) > 0.0));
}

// Limits `v` to the greatest value that a pass's target holds.
fn capped(v: vec3f, most: f32) -> vec3f {
    return min(v, vec3f(most));
}

// Limits `v` to 0 and more.
fn not_negative(v: vec3f) -> vec3f {
    return max(v, vec3f(0.0));
}

// Returns `shown`, the picture's value for `light`. Marks nothing: guarded_checked.wgsl marks pixels whose light is not
// finite, by a NaN if the picture `is_float`, else in magenta.
fn marked(shown: vec3f, light: vec3f, is_float: bool) -> vec3f {
    return shown;
}
