//! Visibility and fog drawn into the host's picture from its depth.
