// First half of a step: decides where each bead goes. A larger bead takes in a bead that it touches. Otherwise the bead
// runs if gravity and air overcome the retention, and leaves small beads behind.
//!include "glass/cells.wgsl"

// Returns whether the bead `larger`, `offset` away, takes in the bead of `radius` (both in 1/256 cell): the two touch,
// and `larger` does not run away.
fn takes(larger: vec4u, offset: vec2i, radius: i32) -> bool {
    let other = bead(larger.x);
    let reach = ((radius + (other.x & 1023)) * 3) >> 2u;
    if offset.x * offset.x + offset.y * offset.y > reach * reach {
        return false;
    }
    return (larger.z & 0xffffu) == 0u || (offset.x * (other.y >> 4u) + offset.y * (other.z >> 4u)) <= 0;
}

// Returns the film of a cell; 0 outside the lattice.
fn film_at(cell: vec2i) -> i32 {
    if !inside(cell) {
        return 0;
    }
    return i32(textureLoad(cells, cell, 0).w >> 16u);
}

// Returns the sideways share of a running bead's motion, in 1/256. The glass is uneven, and wet glass attracts the
// bead.
fn steer(cell: vec2i, motion: vec2i) -> i32 {
    let size = abs(motion);
    let ahead = vec2i(select(0, sign(motion.x), 2 * size.x > size.y), select(0, sign(motion.y), 2 * size.y > size.x));
    let left = vec2i(-ahead.y, ahead.x);
    let uneven = i32(cell_hash(cell, step.key.y) & 255u) - 128;
    let wetter = film_at(cell + ahead + left) - film_at(cell + ahead - left);
    return (uneven >> 1u) + clamp(wetter >> 9u, -64, 64);
}

// Returns the move of a cell's bead.
@fragment
fn decide(in: FullscreenVarying) -> @location(0) vec4u {
    let cell = vec2i(in.position.xy);
    let here = textureLoad(cells, cell, 0);
    let flags = select(0u, WIPED, swept(cell * 16 + 8));
    if here.x == 0u {
        return vec4u(0u, 0u, 0u, flags);
    }
    let at = place(here.y);
    if swept(cell * 16 + (at >> vec2u(12u))) {
        return vec4u(0u, 0u, 0u, flags);
    }
    let law = bead(here.x);
    var taker = here;
    var to = vec2i(0);
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let n = vec2i(x, y);
            if (x == 0 && y == 0) || !inside(cell + n) {
                continue;
            }
            let other = textureLoad(cells, cell + n, 0);
            let after = y > 0 || (y == 0 && x > 0);
            let larger = other.x > taker.x || (other.x == here.x && taker.x == here.x && after);
            let offset = n * 256 + (place(other.y) >> vec2u(8u)) - (at >> vec2u(8u));
            if larger && takes(other, offset, law.x & 1023) {
                taker = other;
                to = n;
            }
        }
    }
    if to.x != 0 || to.y != 0 {
        let where_to = u32((to.y + 1) * 3 + to.x + 1);
        return vec4u(here.x, taker.y, here.z & 0xffff0000u, flags | where_to);
    }
    return run(cell, here, law, flags);
}

// Returns the move of a bead that no other bead takes in.
fn run(cell: vec2i, here: vec4u, law: vec4i, flags: u32) -> vec4u {
    let pinned = 180 + i32((cell_hash(cell, step.key.y) >> 8u) % 154u);
    let glides = (here.z & 0xffffu) != 0u || (here.w >> 16u) > WET_FILM || law.w > pinned;
    let motion = law.yz;
    if !glides || (motion.x == 0 && motion.y == 0) {
        return vec4u(here.x, here.y, here.z & 0xffff0000u, flags | 4u);
    }
    let aside = steer(cell, motion);
    let way = motion + ((vec2i(-motion.y, motion.x) * aside) >> vec2u(8u));
    let held = clamp(way, vec2i(-65000), vec2i(65000));
    let reached = place(here.y) + held;
    let to = reached >> vec2u(16u);
    let random = cell_hash(cell, step.key.x);
    var left = 0u;
    if (to.x != 0 || to.y != 0) && (random & 15u) < 10u {
        left = here.x >> (5u + ((random >> 4u) & 3u));
    }
    let speed = u32(max(1, (abs(held.x) + abs(held.y)) >> 1u));
    let where_to = u32((to.y + 1) * 3 + to.x + 1);
    let place_there = packed(reached & vec2i(0xffff));
    return vec4u(here.x - left, place_there, (here.z & 0xffff0000u) | speed, flags | RAN | where_to | (left << 8u));
}
