// List of the things (drops, flakes, stones) that the picture shows, among all that fall around the camera. Each thing
// has a bit, in the order of the things' indices. The list keeps this order, so that it does not depend on the
// scheduling of threads. src/particles/listing.rs describes the passes.

// Words of bits in a block.
const WORDS: u32 = 4u;

// Block of things.
struct Block {
    // Bit of each thing: 1 if the picture may show it.
    seen: array<u32, WORDS>,
    // Number of seen things in all blocks before this one.
    before: u32,
}

@group(1) @binding(0) var<storage, read_write> blocks: array<Block>;

// Returns the number of blocks for `things` things.
fn blocks_of(things: u32) -> u32 {
    return (things + 32u * WORDS - 1u) / (32u * WORDS);
}

// Returns the number of seen things in a block.
fn seen_in(block: u32) -> u32 {
    var sum = 0u;
    for (var i = 0u; i < WORDS; i++) {
        sum += countOneBits(blocks[block].seen[i]);
    }
    return sum;
}

// Returns the number of things listed in the first `all` blocks, at most `room`.
fn listed(all: u32, room: u32) -> u32 {
    return min(blocks[all - 1u].before + seen_in(all - 1u), room);
}

// Returns the index of the thing at position `rank` of the list, which must have more things than `rank`.
fn thing_at(rank: u32, all: u32) -> u32 {
    // Finds the last block that begins at `rank` or before.
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
    // Finds the word in that block, then the bit in the word.
    var left = rank - blocks[block].before;
    var word = 0u;
    var bits = blocks[block].seen[0];
    while word + 1u < WORDS && left >= countOneBits(bits) {
        left -= countOneBits(bits);
        word += 1u;
        bits = blocks[block].seen[word];
    }
    // The limit of 31 keeps the loop finite even for a list that no pass has filled.
    for (left = min(left, 31u); left > 0u; left--) {
        bits &= bits - 1u;
    }
    return 32u * (WORDS * block + word) + firstTrailingBit(bits);
}
