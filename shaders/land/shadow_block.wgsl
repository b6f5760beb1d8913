// Texels along a side of a block of a shadow map.
const SHADOW_BLOCK: i32 = 16;
