// The streaks of the drops that rain/cull.wgsl has found: once a drop what it costs to know whether it got there, and in what
// light.
//!include "rain/cull_list.wgsl"

@compute @workgroup_size(64)
fn make_streaks(@builtin(global_invocation_id) id: vec3u) {
    // The last block that begins here or before.
    var block = 0u;
    var end = rain.shells * shell_blocks();
    let last = end - 1u;
    if id.x >= min(blocks[last].before + seen_in(last), arrayLength(&streaks)) {
        return;
    }
    while end - block > 1u {
        let middle = (block + end) / 2u;
        if blocks[middle].before <= id.x {
            block = middle;
        } else {
            end = middle;
        }
    }
    // The word in it, and the bit in that.
    var rank = id.x - blocks[block].before;
    var word = 0u;
    var bits = blocks[block].seen[0];
    while word + 1u < WORDS && rank >= countOneBits(bits) {
        rank -= countOneBits(bits);
        word += 1u;
        bits = blocks[block].seen[word];
    }
    for (; rank > 0u; rank--) {
        bits &= bits - 1u;
    }
    let s = block / shell_blocks();
    let index = 32u * (WORDS * (block % shell_blocks()) + word) + firstTrailingBit(bits);
    let m = moving(class_in_shell(s, class_of(index)), index);
    // A rain area's rim thins what is left.
    streaks[id.x] = streak_of(m.drop, m.velocity, m.drop.share > 0.0);
}
