//! The sky from below the ground's level to space.
