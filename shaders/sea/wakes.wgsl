// Wakes of hulls: the waves of bow and stern along a hull's track, and the foam of its wash. src/sea/wake_field.rs is
// the f64 reference and has the formulas; names are the same.
//!include "sea/uniform.wgsl"

const WAKE_GRAVITY: f32 = 9.81;
const WAKE_TAU: f32 = 6.28318531;
const PLANING: vec2f = vec2f(0.5, 0.9);
const AIRY_MODULUS: f32 = 0.3987;
const AIRY_0: f32 = 0.35502805;
const AIRY_PHASE: vec2f = vec2f(-0.26179939, 2.2);
const LAST_AIRY: f32 = 6.0;
const BEYOND_CUSP: vec2f = vec2f(1.2, 1.6);
const LEAST_BEND: f32 = 0.1;
const CUSP_BENDS: vec2f = vec2f(0.05, 0.3);
const MOST_WAKE_STEEPNESS: f32 = 0.3;
const WAKE_BEGINNING: f32 = 0.1;
const WAKE_SPEEDS: vec2f = vec2f(0.7, 1.5);
const WAKE_BREAKS: vec2f = vec2f(0.35, 1.0);
const BROKEN_SHARE: f32 = 0.6;
const WASH_SHARE: f32 = 0.75;
const WASH_DECAY: f32 = 10.0;
const WASH_WIDTH: f32 = 0.45;
// Age at which the wash is taken as gone, s.
const WASH_LASTS: f32 = 60.0;
const WASH_SPEEDS: vec2f = vec2f(0.5, 5.0);
const WAKE_FADES: vec2f = vec2f(0.2, 3.0);

// Kinds of waves.
const DIVERGING: u32 = 0u;
const TRANSVERSE: u32 = 1u;
const BEYOND: u32 = 2u;

// Waves that are let through: those of the mesh by their length, or those of a pixel by its filter.
struct WakeFilter {
    // Cells of the mesh in a metre; 0 for a pixel.
    per_cell: f32,
    // Deviations of the pixel's filter with their directions, m.
    along: vec2f,
    across: vec2f,
    // Shortest wave that is told apart, m.
    shortest: f32,
}

// Surface of wakes at a place.
struct WakeSurface {
    height: f32,
    slope: vec2f,
    // Share under foam.
    foam: f32,
}

fn hull_state(wake: SeaWake, index: u32) -> HullState {
    return sea_tracks[min(wake.first + index, MOST_TRACK_STATES - 1u)];
}

// Bow or stern in a state.
struct HullEnd {
    place: vec2f,
    velocity: vec2f,
    // Acceleration that the rate of turn causes.
    turning: vec2f,
    age: f32,
}

// Bow or stern, which is `off_middle` m ahead of the hull's middle.
fn end_of(state: HullState, off_middle: f32) -> HullEnd {
    let velocity = state.velocity + vec2f(-state.ahead.y, state.ahead.x) * (state.turn * off_middle);
    let place = state.place + state.ahead * off_middle;
    return HullEnd(place, velocity, vec2f(-velocity.y, velocity.x) * state.turn, state.age);
}

// S of a place for a state, and the derivative of S by age. The two passages that meet in this state have the same two
// values here.
fn s_of(end: HullEnd, at: vec2f) -> vec2f {
    let to_place = at - end.place;
    let along = dot(end.velocity, to_place);
    let turned = dot(end.turning, to_place) - dot(end.velocity, end.velocity);
    return vec2f(dot(to_place, to_place) - 0.5 * end.age * along, 1.5 * along + 0.5 * end.age * turned);
}

// Motion of bow or stern between two states, as a cubic of the age.
struct Passage {
    start: f32,
    span: f32,
    a: vec2f,
    b: vec2f,
    c: vec2f,
    d: vec2f,
}

fn passage_of(newer: HullEnd, older: HullEnd) -> Passage {
    let span = max(older.age - newer.age, 1e-6);
    let way = older.place - newer.place;
    let v = -newer.velocity * span;
    let w = -older.velocity * span;
    return Passage(newer.age, span, newer.place, v, way * 3.0 - v * 2.0 - w, v + w - way * 2.0);
}

// Bow or stern at an age, seen from a place.
struct WakeSource {
    age: f32,
    to_place: vec2f,
    velocity: vec2f,
    // S and its derivatives by age.
    s: vec3f,
}

fn source_at(passage: Passage, at: vec2f, past: f32) -> WakeSource {
    let h = passage.span;
    let t = past / h;
    let to_place = at - (passage.a + (passage.b + (passage.c + passage.d * t) * t) * t);
    let velocity = -(passage.b + (passage.c * 2.0 + passage.d * (3.0 * t)) * t) / h;
    let change = (passage.c * 2.0 + passage.d * (6.0 * t)) / (h * h);
    let jerk = passage.d * (-6.0 / (h * h * h));
    let u = passage.start + past;
    let along = dot(velocity, to_place);
    let turned = dot(change, to_place);
    let s = vec3f(
        dot(to_place, to_place) - 0.5 * u * along,
        1.5 * along - 0.5 * u * dot(velocity, velocity) + 0.5 * u * turned,
        dot(velocity, velocity) - turned + 1.5 * u * dot(change, velocity) - 0.5 * u * dot(jerk, to_place),
    );
    return WakeSource(u, to_place, velocity, s);
}

// Share of the height with which waves of an age are drawn: waves fade at both ends of a track.
fn wake_age_share(age: f32, newest: f32, oldest: f32) -> f32 {
    let fading = WAKE_FADES.x * max(oldest - newest, 1e-6);
    let old = smoothstep(0.0, fading, oldest - age);
    let fresh = smoothstep(0.0, min(fading, WAKE_FADES.y), age - newest);
    return old * select(1.0, fresh, newest > 0.0);
}

// Cube root and fourth root of a number that is not negative.
fn cube_root(x: f32) -> f32 {
    return pow(max(x, 1e-30), 0.33333333);
}

fn fourth_root(x: f32) -> f32 {
    return sqrt(sqrt(max(x, 0.0)));
}

fn airy_beyond(x: f32) -> f32 {
    return AIRY_0 * exp(-0.66666667 * x * sqrt(x)) * fourth_root(AIRY_MODULUS / (x + AIRY_MODULUS));
}

// Share of a wave that a filter lets through.
fn wake_share(turns: vec2f, turns_per_m: f32, pass_filter: WakeFilter) -> f32 {
    if pass_filter.per_cell > 0.0 {
        return clamp(pass_filter.per_cell / (max(turns_per_m, 1e-5) * 1.5) - 1.0, 0.0, 1.0);
    }
    let a = dot(turns, pass_filter.along);
    let b = dot(turns, pass_filter.across);
    let end = turns_per_m * pass_filter.shortest;
    let left = max(1.0 - max(6.57973627 * (a * a + b * b), end * end), 0.0);
    return left * left;
}

// Adds a wave of a hull's end; `end` is 1 for the bow and -1 for the stern.
fn add_wake_wave(wake: SeaWake, source: WakeSource, kind: u32, end: f32, pass_filter: WakeFilter, sum: ptr<function, WakeSurface>) {
    let moving = length(source.velocity);
    if source.age <= 0.0 || moving <= WAKE_SPEEDS.x {
        return;
    }
    let u = max(source.age, 1e-6);
    let speed = max(moving, WAKE_SPEEDS.x);
    let speed2 = speed * speed;
    let distance = max(length(source.to_place), 1e-6);
    let is_beyond = kind == BEYOND;
    // A place beyond a cusp has the waves of the cusp. The cusp is at the distance at which S would be 0.
    let far = max(select(distance, sqrt(max(distance * distance - source.s.x, 0.0)), is_beyond), 1e-6);
    let cosine = clamp(2.0 * far / (speed * u), 1e-3, 1.0);
    // Hulls are no faster than 60 m/s.
    let k_along = max(WAKE_GRAVITY / (speed2 * cosine), 1e-3);
    let k = k_along / cosine;
    let direction = source.to_place / distance;
    let turns_per_m = max(k / WAKE_TAU, 1e-5);
    let passed = wake_share(direction * turns_per_m, turns_per_m, pass_filter);
    if passed <= 0.0 {
        return;
    }
    let planing = smoothstep(PLANING.x, PLANING.y, speed / sqrt(WAKE_GRAVITY * wake.length));
    let width = k * wake.beam * pow(wake.length / wake.beam, 0.5 * planing) / WAKE_TAU;
    let deep = 1.0 - exp(-k * wake.draught);
    let base = 16.0 * wake.beam * deep * exp(-min(width * width, 80.0)) / (WAKE_TAU * cosine * wake.length * wake.length);
    let raw = vec2f(end / (k_along * k_along), 0.5 * wake.length / k_along) * base;
    let factor = WAKE_GRAVITY * u / (2.0 * far * far * far);
    let half_bend = 0.5 * max(select(abs(source.s.z), source.s.z, is_beyond), LEAST_BEND * speed2);
    let third = factor * half_bend;
    let near_u = u + WAKE_BEGINNING * wake.length / speed;
    var size = 2.50662827 / near_u * wake_age_share(u, wake.newest, wake.oldest) * smoothstep(WAKE_SPEEDS.x, WAKE_SPEEDS.y, speed);
    var phase = -WAKE_GRAVITY * u * u / (4.0 * distance);
    let root = cube_root(third);
    if is_beyond {
        let least = max(source.s.x - source.s.y * source.s.y / (4.0 * half_bend), 0.0);
        let ratio = factor / max(root * root, 1e-20);
        let beyond = ratio * ratio * half_bend * least;
        let gone = smoothstep(BEYOND_CUSP.x, BEYOND_CUSP.y, distance / far);
        let comes = smoothstep(CUSP_BENDS.x, CUSP_BENDS.y, source.s.z / speed2);
        if beyond > LAST_AIRY {
            return;
        }
        size *= 3.54490770 * airy_beyond(beyond) / root * (1.0 - gone) * comes;
    } else {
        let second = factor * abs(source.s.y);
        let four_thirds = root * third;
        let argument = second * second / max(4.0 * four_thirds, 1e-30);
        let later = AIRY_PHASE.x / (1.0 + AIRY_PHASE.y * argument * sqrt(argument));
        let turned = select(later - 0.78539816, 0.78539816 - later, kind == DIVERGING);
        let flat = source.s.y * source.s.y + 1e-6 * speed2 * speed2 * u * u;
        let off = 0.5 * factor * source.s.x * source.s.x * source.s.y / max(flat, 1e-20);
        size /= max(fourth_root(0.25 * second * second + AIRY_MODULUS * four_thirds), 1e-10);
        phase += clamp(off, -0.5, 0.5) + turned;
    }
    let unlimited = size * length(raw);
    let steepness = unlimited * k;
    let limited = steepness / MOST_WAKE_STEEPNESS;
    let amplitude = passed * unlimited / sqrt(1.0 + limited * limited);
    let unit = raw / max(length(raw), 1e-20);
    let turn = vec2f(sin(phase) * unit.x + cos(phase) * unit.y, cos(phase) * unit.x - sin(phase) * unit.y);
    (*sum).height += amplitude * turn.y;
    (*sum).slope -= direction * (amplitude * k * turn.x);
    (*sum).foam += passed * BROKEN_SHARE * smoothstep(WAKE_BREAKS.x, WAKE_BREAKS.y, steepness) * max(turn.y, 0.0);
}

// Times of a half passage at which S = s + d t + q t^2 falls through 0, rises through 0, and is least above 0; -1 for
// none.
fn wave_times(parabola: vec3f) -> vec3f {
    let s = parabola.x;
    let d = parabola.y;
    let q = parabola.z;
    let square = d * d - 4.0 * q * s;
    let root = sqrt(max(square, 0.0));
    let twice = 2.0 * q;
    let not_flat = select(twice, select(-1e-20, 1e-20, twice >= 0.0), abs(twice) < 1e-20);
    // Each zero is computed in the form in which no digits cancel.
    let falling = select(-(d + root) / not_flat, 2.0 * s / max(root - d, 1e-20), d < 0.0);
    let rising = select((root - d) / not_flat, -2.0 * s / max(d + root, 1e-20), d > 0.0);
    let least = select(-1.0, -d / not_flat, q > 0.0);
    return select(vec3f(-1.0, -1.0, least), vec3f(falling, rising, -1.0), square > 0.0);
}

// Adds the waves of a passage, from S and its slope at both ends. Between the ends S is taken as two parabolas with a
// common tangent in the middle.
fn add_passage(wake: SeaWake, passage: Passage, first: vec2f, last: vec2f, at: vec2f, end: f32, pass_filter: WakeFilter, sum: ptr<function, WakeSurface>) {
    let h = passage.span;
    let middle_slope = 2.0 * (last.x - first.x) / h - 0.5 * (first.y + last.y);
    let middle = first.x + 0.25 * h * (first.y + middle_slope);
    let newer = wave_times(vec3f(first, (middle_slope - first.y) / h));
    let older = wave_times(vec3f(middle, middle_slope, (last.y - middle_slope) / h));
    for (var i = 0u; i < 6u; i++) {
        let is_older = i >= 3u;
        let kind = select(i, i - 3u, is_older);
        let times = select(newer, older, is_older);
        let t = select(select(times.z, times.y, kind == TRANSVERSE), times.x, kind == DIVERGING);
        if t >= 0.0 && t < 0.5 * h {
            let source = source_at(passage, at, t + select(0.0, 0.5 * h, is_older));
            add_wake_wave(wake, source, kind, end, pass_filter, sum);
        }
    }
}

// Foam that a hull has churned up, at a place.
fn wash_at(wake: SeaWake, at: vec2f) -> f32 {
    var wash = 0.0;
    var newer = hull_state(wake, 0u);
    for (var i = 1u; i < min(wake.states, MOST_WAKE_STATES); i++) {
        let older = hull_state(wake, i);
        let a = newer.place - newer.ahead * (0.5 * wake.length);
        let way = older.place - older.ahead * (0.5 * wake.length) - a;
        let part = clamp(dot(at - a, way) / max(dot(way, way), 1e-9), 0.0, 1.0);
        let off = at - a - way * part;
        // Foam is computed only within one beam of the track.
        if newer.age < WASH_LASTS && dot(off, off) < wake.beam * wake.beam {
            let age = max(mix(newer.age, older.age, part), 0.0);
            let speed = mix(length(newer.velocity), length(older.velocity), part);
            let half_width = WASH_WIDTH * wake.beam * fourth_root(1.0 + speed * age / (2.0 * wake.length));
            let inside = max(1.0 - dot(off, off) / max(half_width * half_width, 1e-9), 0.0);
            wash = max(wash, WASH_SHARE * smoothstep(WASH_SPEEDS.x, WASH_SPEEDS.y, speed) * exp(-age / WASH_DECAY) * inside);
        }
        newer = older;
    }
    return wash;
}

// Adds the waves of bow and stern. `add_passage` is called at one place only, because drivers copy a function to each
// place that calls it.
fn add_wake(wake: SeaWake, at: vec2f, pass_filter: WakeFilter, sum: ptr<function, WakeSurface>) {
    let states = clamp(wake.states, 1u, MOST_WAKE_STATES);
    var newer = end_of(hull_state(wake, 0u), 0.0);
    var first = vec2f(0.0);
    for (var i = 0u; i < 2u * states; i++) {
        let is_bow = i < states;
        let end = select(-1.0, 1.0, is_bow);
        let index = select(i - states, i, is_bow);
        let older = end_of(hull_state(wake, index), 0.5 * end * wake.length);
        let last = s_of(older, at);
        // If S is positive at both ends of a passage, S has a zero or a least value in between only if S falls at the
        // first end and rises at the last.
        if index > 0u && (first.x <= 0.0 || last.x <= 0.0 || (first.y < 0.0 && last.y > 0.0)) {
            add_passage(wake, passage_of(newer, older), first, last, at, end, pass_filter, sum);
        }
        newer = older;
        first = last;
    }
}

// Surface of the wakes at a place, m from the anchor. No pixel leaves a turn of the loop early. The row therefore stays
// the same for all lanes of a driver, which then read one place of a block.
fn wakes_at(at: vec2f, pass_filter: WakeFilter) -> WakeSurface {
    var sum: WakeSurface;
    for (var row = 0u; row < min(sea_band.wakes, MOST_SEA_HULLS); row++) {
        let wake = sea_wakes[row];
        let off = at - wake.middle;
        if dot(off, off) <= wake.reach2 {
            // None of the hull's waves is longer than those that run along the hull's track.
            if wake_share(vec2f(0.0), wake.least_turns, pass_filter) > 0.0 {
                add_wake(wake, at, pass_filter, &sum);
            }
            if pass_filter.per_cell == 0.0 {
                sum.foam = min(sum.foam + wash_at(wake, at), 1.0);
            }
        }
    }
    return sum;
}
