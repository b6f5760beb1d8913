// Computes the streaks of the drops that rain/cull.wgsl has found. The costly tests, for shelter and for light, run
// once a drop here.
//!include "rain/cull_list.wgsl"

// Writes streak `id.x` of the list.
@compute @workgroup_size(64)
fn make_streaks(@builtin(global_invocation_id) id: vec3u) {
    let all = rain.shells * shell_blocks();
    // `states` is read here although only stepped drops have any. If a declared block is not used, zink of Mesa 26.2
    // returns the length of another block instead of the requested one.
    if id.x >= listed(all, arrayLength(&streaks)) || arrayLength(&states) == 0u {
        return;
    }
    let thing = thing_at(id.x, all);
    let of_shell = 32u * WORDS * shell_blocks();
    let index = thing % of_shell;
    let m = moving(class_in_shell(thing / of_shell, class_of(index)), index);
    // Tests the share again: it may be 0 where a rim of a rain area thins the drops.
    streaks[id.x] = streak_of(m.drop, m.velocity, m.drop.share > 0.0);
}
