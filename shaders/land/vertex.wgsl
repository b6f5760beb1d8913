// Vertices of the drawn terrain. A patch has 8 x 8 squares of its page's level. The twin of `patch_vertex` on the CPU
// is `vertex` in src/land/reference.rs.
//!include "land/uniform.wgsl"

// Slots in a row of the pages' textures, and vertices and texels along a side of a slot.
const SLOTS_IN_ROW: u32 = 32u;
const PAGE_VERTICES: i32 = 17;
const PAGE_TEXELS: i32 = 66;
// Vertices along a side of a patch.
const PATCH_VERTICES: u32 = 9u;

struct LandVarying {
    @builtin(position) position: vec4f,
    // Place from the eye along the lattice's axes, m.
    @location(0) place: vec3f,
    // Place in the page, texels.
    @location(1) texel: vec2f,
    // Share of the next coarser level.
    @location(2) morph: f32,
    // South-western texel of the page's slot.
    @location(3) @interpolate(flat) slot: vec2i,
    // 1 where the page has holes.
    @location(4) @interpolate(flat) has_holes: u32,
}

// Corner of a slot with `side` texels a side.
fn slot_corner(slot: u32, side: i32) -> vec2i {
    return vec2i(i32(slot % SLOTS_IN_ROW), i32(slot / SLOTS_IN_ROW)) * side;
}

// Place of a page's vertex along the lattice's axes, m from the eye. `cell` is counted from the cell below the eye.
fn vertex_place(cell: vec2i, height: f32) -> vec3f {
    return vec3f((vec2f(cell) - land.eye.xy) * land.cell_m, (height - land.eye.z) - land.eye.w);
}

// Share of the next coarser level at a vertex: a function of its place alone.
fn morph_at(cell: vec2i, level: u32) -> f32 {
    let flat_place = (vec2f(cell) - land.eye.xy) * land.spread;
    let distance = sqrt(max(dot(flat_place, flat_place) + land.above * land.above, 0.0));
    let morph = land.levels[min(level, 26u)];
    return clamp((distance - morph.x) * morph.y, 0.0, 1.0);
}

// Vertex of a patch.
fn patch_vertex(index: u32, low: vec2i, page: vec2u) -> LandVarying {
    let level = page.y & 255u;
    let quarter = vec2i(i32((page.y >> 8u) & 1u), i32((page.y >> 9u) & 1u));
    let at = vec2i(i32(index % PATCH_VERTICES), i32(index / PATCH_VERTICES));
    let odd = at & vec2i(1);
    let corner = slot_corner(page.x, PAGE_VERTICES) + quarter * 8;
    let cell = low + (at << vec2u(level));
    // Odd vertices move along their edge or diagonal onto the even ones, which the next coarser level has too.
    let coarse_cell = low + ((at - odd) << vec2u(level));
    let own = vertex_place(cell, textureLoad(page_heights, corner + at, 0).r);
    let coarse = vertex_place(coarse_cell, textureLoad(page_heights, corner + at - odd, 0).r);
    let morph = morph_at(cell, level);
    let place = select(own + (coarse - own) * morph, coarse, morph >= 1.0);
    let squares = vec2f(quarter * 8 + at) - vec2f(odd) * morph;
    let texels_in_square = f32(1u << min(level, 2u));
    return LandVarying(
        land.clip * vec4f(place, 1.0),
        place,
        squares * texels_in_square,
        morph,
        slot_corner(page.x, PAGE_TEXELS),
        (page.y >> 10u) & 1u,
    );
}
