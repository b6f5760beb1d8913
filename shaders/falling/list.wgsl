// The list of things that a picture shows, of all that fall round the camera: which they are stands in a bit each, in
// the order of their numbers, so the list's order is that order and depends on no thread's haste.
// src/particles/listing.rs describes the passes.

// Words of bits of a block.
const WORDS: u32 = 4u;

struct Block {
    seen: array<u32, WORDS>,
    // Things that are seen in the blocks before.
    before: u32,
}

@group(1) @binding(0) var<storage, read_write> blocks: array<Block>;

// Blocks for so many things.
fn blocks_of(things: u32) -> u32 {
    return (things + 32u * WORDS - 1u) / (32u * WORDS);
}

fn seen_in(block: u32) -> u32 {
    var sum = 0u;
    for (var i = 0u; i < WORDS; i++) {
        sum += countOneBits(blocks[block].seen[i]);
    }
    return sum;
}

// How many things the first `all` blocks have, where room is for `room`.
fn listed(all: u32, room: u32) -> u32 {
    return min(blocks[all - 1u].before + seen_in(all - 1u), room);
}

// Number of the thing that stands at a rank of the list, which has one there.
fn thing_at(rank: u32, all: u32) -> u32 {
    // The last block that begins here or before.
    var block = 0u;
    var end = all;
    while end - block > 1u {
        let middle = block + (end - block) / 2u;
        if blocks[middle].before <= rank {
            block = middle;
        } else {
            end = middle;
        }
    }
    // The word in it, and the bit in that.
    var left = rank - blocks[block].before;
    var word = 0u;
    var bits = blocks[block].seen[0];
    while word + 1u < WORDS && left >= countOneBits(bits) {
        left -= countOneBits(bits);
        word += 1u;
        bits = blocks[block].seen[word];
    }
    // No word has more, whatever a list holds that nothing has filled.
    for (left = min(left, 31u); left > 0u; left--) {
        bits &= bits - 1u;
    }
    return 32u * (WORDS * block + word) + firstTrailingBit(bits);
}
