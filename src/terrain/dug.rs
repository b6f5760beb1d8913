//! A cell that was dug or covered: its height, and the soil that shows in it.

/// Soil that shows in a cell, for drawing the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct DugColor {
    /// Linear Rec. 709 albedo times the share of the cell that the soil covers, in codes of sRGB. Products of colour
    /// and share can be interpolated over the edge of the dug ground.
    pub albedo: [u8; 3],
    /// Share of the cell that the soil covers, in 255ths.
    pub share: u8,
}

/// A cell whose height or colour the soil has changed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct DugCell {
    /// Index in the tile.
    pub cell: usize,
    /// Height above the terrain's origin, m.
    pub height_m: f32,
    pub color: DugColor,
}
