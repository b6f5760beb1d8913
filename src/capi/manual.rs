//! Welkin: weather drawn into a simulator's own picture.
//!
//! (The article is written when the interface stands.)
