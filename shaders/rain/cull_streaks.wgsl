// Computes the streaks of the drops that rain/cull.wgsl has found. The costly parts are the test for shelter and the
// light; here they run once for each drop, not at each corner of its quad.
//!include "rain/cull_list.wgsl"

// Writes streak `id.x` of the list.
@compute @workgroup_size(64)
fn make_streaks(@builtin(global_invocation_id) id: vec3u) {
    let all = rain.shells * shell_blocks();
    // Reads the length of `states`, although only stepped drops have states: if a shader declares a block and does not
    // use it, zink of Mesa 26.2 returns the length of another block instead of that of `streaks`.
    if id.x >= listed(all, arrayLength(&streaks)) || arrayLength(&states) == 0u {
        return;
    }
    let thing = thing_at(id.x, all);
    let of_shell = 32u * WORDS * shell_blocks();
    let index = thing % of_shell;
    let m = moving(class_in_shell(thing / of_shell, class_of(index)), index);
    // Tests the share again: rain/cull.wgsl runs without AREAS, so at the rim of a rain area a drop that it found may
    // have the share 0.
    streaks[id.x] = streak_of(m.drop, m.velocity, m.drop.share > 0.0);
}
