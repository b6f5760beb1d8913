// Arithmetic that has an answer for every operand, and the limits that light is brought into on its way to a picture. A
// value that is not a number reaches a picture as black or, through `min`, as the brightest value there is: where debug
// assertions are on, guarded_checked.wgsl stands here and lets it be seen.

// Unit vector along `v`, or `other` where `v` is zero and points nowhere.
fn unit_or(v: vec3f, other: vec3f) -> vec3f {
    return normalize(select(other, v, dot(v, v) > 0.0));
}

// At most what the target of a pass holds.
fn capped(v: vec3f, most: f32) -> vec3f {
    return min(v, vec3f(most));
}

fn not_negative(v: vec3f) -> vec3f {
    return max(v, vec3f(0.0));
}

// What a picture shows of `light`, or a mark where that is no light.
fn marked(shown: vec3f, light: vec3f, is_float: bool) -> vec3f {
    return shown;
}
