// Second half of a step: beads that move in, evaporation, wiping, and drops that land.
//!include "glass/cells.wgsl"

// Cell while its parts are joined: volume and largest part, units; place and motion of the largest part.
struct Cell {
    volume: u32,
    largest: u32,
    place: u32,
    motion: u32,
}

// Returns a cell with water added. The largest part keeps its place, speed and shape.
fn join(to: Cell, volume: u32, at: u32, motion: u32) -> Cell {
    var c = to;
    c.volume += volume;
    if volume > c.largest {
        c.largest = volume;
        c.place = at;
        c.motion = motion;
    }
    return c;
}

// Returns the state of a cell after the step.
@fragment
fn gather(in: FullscreenVarying) -> @location(0) vec4u {
    let cell = vec2i(in.position.xy);
    let before = textureLoad(cells, cell, 0);
    let own = textureLoad(moves, cell, 0);
    var c = Cell(0u, 0u, 0u, 0u);
    var ran = (own.w & RAN) != 0u;
    if (own.w >> 8u) > 0u {
        c = join(c, own.w >> 8u, before.y, pcg(before.z) & 0xffff0000u);
    }
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let near = cell + vec2i(x, y);
            if !inside(near) {
                continue;
            }
            let m = textureLoad(moves, near, 0);
            if m.x > 0u && (m.w & 15u) == u32((1 - y) * 3 + 1 - x) {
                c = join(c, m.x, m.y, m.z);
                ran = ran || (m.w & RAN) != 0u;
            }
        }
    }
    let wiped = (own.w & WIPED) != 0u;
    c = dried(cell, c);
    // Meltwater becomes a bead or joins one. A blade removes the snow before it melts.
    if step.snow.z > 0u && !wiped {
        let melt = melted(cell, textureLoad(snow, cell, 0).x);
        if melt > 0u {
            let at = cell_hash(cell, step.key.y + 13u);
            c = join(c, melt, at, at << 16u);
        }
    }
    return landed(cell, c, cleared(cell, before.w, ran, wiped));
}

// Returns a bead after evaporation. The fraction of a unit is rounded at random.
fn dried(cell: vec2i, bead_there: Cell) -> Cell {
    var c = bead_there;
    if c.volume > 0u {
        let loss = u32(bead(c.volume).x) >> 10u;
        let random = cell_hash(cell, step.key.x + 1u) & 4095u;
        c.volume -= min(c.volume, (loss >> 12u) + select(0u, 1u, random < (loss & 4095u)));
        c.largest = c.volume;
    }
    return c;
}

// Returns hits, clearings and film, packed, after running and wiping, and after evaporation.
fn cleared(cell: vec2i, packed_state: u32, ran: bool, wiped: bool) -> u32 {
    var hits = packed_state & MOST_HITS;
    var clearings = (packed_state >> 12u) & 15u;
    var film = packed_state >> 16u;
    film -= min(film, (film >> 4u) + 64u);
    if hits > 0u && (cell_hash(cell, step.key.x + 2u) >> 16u) < step.arrive.w {
        hits -= 1u;
    }
    if ran || wiped {
        clearings = (clearings + select(0u, 1u, hits > 0u)) & 15u;
        hits = 0u;
        film = FULL_FILM;
    }
    return hits | (clearings << 12u) | (film << 16u);
}

// Returns the state of a cell after the drops that land in the step.
fn landed(cell: vec2i, bead_there: Cell, state: u32) -> vec4u {
    var c = bead_there;
    var random = cell_hash(cell, step.key.x + 3u);
    // With a share s of the rain, two drops in a step are rarer by the factor s^2, and three by s^3.
    let share = reached(cell);
    let one = part_of(step.arrive.x, share);
    let two = part_of(part_of(step.arrive.y, share), share);
    let three = part_of(part_of(part_of(step.arrive.z, share), share), share);
    let count = select(0u, 1u, random < one) + select(0u, 1u, random < two) + select(0u, 1u, random < three);
    for (var i = 0u; i < count; i++) {
        random = pcg(random + 1u);
        let at = pcg(random + 2u);
        c = join(c, drop_volume(random), at, at << 16u);
    }
    let hits = min((state & MOST_HITS) + count, MOST_HITS);
    c.volume = min(c.volume, step.limits.x);
    return vec4u(c.volume, c.place, c.motion, (state & 0xfffff000u) | hits);
}
