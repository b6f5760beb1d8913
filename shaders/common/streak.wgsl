// Coverage of a small moving object during the exposure of a picture.

// Least width of a streak, pixels; a narrower one is drawn fainter instead.
const LEAST_PIXELS: f32 = 1.2;
// Greatest length of a streak to either side, as a share of its distance.
const LONGEST: f32 = 0.8;

// Drawn path and cover of an object that moves by `half`, m, to either side of a position at distance `d`, m. xyz: half
// of the drawn path, m. w: factor for the cover.
//   c = min(|half| / d, LONGEST)
//   xyz = c d half / |half|
//   w = c / atanh(c)
// A streak near the eye is cut to the part of the exposure in which it moves LONGEST d to either side; in that part it
// hides as much as in the whole exposure. Objects at distance d thus darken a ray from d (1 - c) to d (1 + c), which is
// atanh(c) / c times too much, whatever the camera's direction. The factor w corrects this.
fn part_drawn(half: vec3f, d: f32) -> vec4f {
    let whole = length(half) / d;
    let c = min(whole, LONGEST);
    let c2 = c * c;
    // c / atanh(c) within 0.2 %.
    return vec4f(half * (c / max(whole, 1e-9)), 1.0 - c2 * (0.33333333 + c2 * (0.08888889 + 0.085 * c2)));
}

// Time for which a disc covers the point `at`, divided by the longest such time of any point (Garg and Nayar 2007,
// photometric model). The disc has radius 1 and moves from -reach to reach along y. On the path of its centre, for
// reach >= 1, the share of the exposure is tau / T = 1 / reach.
fn passing(at: vec2f, reach: f32) -> f32 {
    let chord = sqrt(max(1.0 - at.x * at.x, 0.0));
    let passed = min(reach, at.y + chord) - max(-reach, at.y - chord);
    return max(passed, 0.0) / (2.0 * min(reach, 1.0));
}

// Greatest share of the exposure for which a point is covered.
fn longest_passing(reach: f32) -> f32 {
    return min(1.0 / reach, 1.0);
}

// Path of a disc in units of its radius, with a minimum for discs that hardly move.
fn reach_of(stretch: f32, radius: f32) -> f32 {
    return max(stretch / radius, 1e-3);
}
