// The streaks of the drops that rain/cull.wgsl has found: once a drop what it costs to know whether it got there, and
// in what light.
//!include "rain/cull_list.wgsl"

@compute @workgroup_size(64)
fn make_streaks(@builtin(global_invocation_id) id: vec3u) {
    let all = rain.shells * shell_blocks();
    // `states` is named although only stepped drops have any: where a declared block is not used, zink of Mesa 26.2
    // answers the length of another block than the one that is asked for.
    if id.x >= listed(all, arrayLength(&streaks)) || arrayLength(&states) == 0u {
        return;
    }
    let thing = thing_at(id.x, all);
    let of_shell = 32u * WORDS * shell_blocks();
    let index = thing % of_shell;
    let m = moving(class_in_shell(thing / of_shell, class_of(index)), index);
    // A rain area's rim thins what is left.
    streaks[id.x] = streak_of(m.drop, m.velocity, m.drop.share > 0.0);
}
