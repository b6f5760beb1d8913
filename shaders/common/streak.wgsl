// What a small thing covers that moves while a picture is exposed.

// A streak is not drawn narrower than this many pixels; it gets fainter instead.
const LEAST_PIXELS: f32 = 1.2;
// A streak is drawn up to this share of its distance to either side.
const LONGEST: f32 = 0.8;

// Half of the way that is drawn of what moves by `half` to either side of a place at distance `d`, and what its cover
// is multiplied by. A streak that nears the eye is cut there, to the part of the exposure in which it goes `LONGEST` of
// `d` to either side, and hides as much in that part as in all of it. So places d (1 - c) to d (1 + c) along a ray are
// darkened, by what is at d, where c is that part: atanh(c) / c times what is there, whatever way the camera looks. The
// factor is its inverse.
fn part_drawn(half: vec3f, d: f32) -> vec4f {
    let whole = length(half) / d;
    let c = min(whole, LONGEST);
    let c2 = c * c;
    // To 0.2 % of c / atanh(c).
    return vec4f(half * (c / max(whole, 1e-9)), 1.0 - c2 * (0.33333333 + c2 * (0.08888889 + 0.085 * c2)));
}

// The part of the exposure for which a disc of radius 1 that goes from -reach to reach along y lies before a place,
// over the most that any place has: the photometric model of Garg and Nayar (2007), whose tau / T is 1 / reach on the
// way of a disc's middle.
fn passing(at: vec2f, reach: f32) -> f32 {
    let chord = sqrt(max(1.0 - at.x * at.x, 0.0));
    let passed = min(reach, at.y + chord) - max(-reach, at.y - chord);
    return max(passed, 0.0) / (2.0 * min(reach, 1.0));
}

// The most of [`passing`] that any place has.
fn longest_passing(reach: f32) -> f32 {
    return min(1.0 / reach, 1.0);
}

// How far a disc of a radius goes in its own radii: what hardly moves has a way all the same.
fn reach_of(stretch: f32, radius: f32) -> f32 {
    return max(stretch / radius, 1e-3);
}
