// The streaks of the drops that rain/cull.wgsl has found: once a drop what it costs to know whether it got there, and in what
// light.
//!include "rain/cull_list.wgsl"

@compute @workgroup_size(64)
fn make_streaks(@builtin(global_invocation_id) id: vec3u) {
    let all = rain.shells * shell_blocks();
    if id.x >= listed(all, arrayLength(&streaks)) {
        return;
    }
    let thing = thing_at(id.x, all);
    let of_shell = 32u * WORDS * shell_blocks();
    let index = thing % of_shell;
    let m = moving(class_in_shell(thing / of_shell, class_of(index)), index);
    // A rain area's rim thins what is left.
    streaks[id.x] = streak_of(m.drop, m.velocity, m.drop.share > 0.0);
}
