//! Role of a host's image in a target: colour, depth, mask, surface classes or normals.

/// Role of an image in a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TargetSide {
    Color,
    Depth,
    Mask,
    Classes,
    Normals,
}

impl TargetSide {
    /// Returns the name of the image in messages: that of its field in `target`.
    pub(super) fn noun(self) -> &'static str {
        &self.parameter()["target.".len()..]
    }

    /// Returns the field's path in errors.
    pub(super) fn parameter(self) -> &'static str {
        match self {
            Self::Color => "target.color",
            Self::Depth => "target.depth",
            Self::Mask => "target.mask",
            Self::Classes => "target.surface_classes",
            Self::Normals => "target.normals",
        }
    }
}
