//! Saved states of contexts on the backend that needs no GPU: they contain all that a host changes between steps, and
//! scripted runs end in the states whose hashes are committed.

mod geoid;
mod inputs;
mod pinned;
mod quiet;
mod whole;
