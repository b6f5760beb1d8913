//! Saved states of contexts on the backend that needs no GPU: what a host changes between steps is in them, and
//! scripted runs end in the states that are committed.

mod geoid;
mod inputs;
mod pinned;
mod quiet;
mod whole;
