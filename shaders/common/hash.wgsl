// Integer hash, with the same results on every device and on the CPU (src/falling/mod.rs).

// pcg3d (Jarzynski and Olano 2020, Hash Functions for GPU Rendering).
fn random3(key: vec3u) -> vec3u {
    var v = key * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> vec3u(16u);
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}
