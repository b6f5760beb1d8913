// Arithmetic that has an answer for every operand. A value that is not a number reaches a picture as black or, through `min`, as the
// brightest value there is.

// Unit vector along `v`, or `other` where `v` is zero and points nowhere.
fn unit_or(v: vec3f, other: vec3f) -> vec3f {
    return normalize(select(other, v, dot(v, v) > 0.0));
}
