//! Cameras, depth conventions and world frames: where things are.
