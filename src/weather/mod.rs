//! The weather as the host says it, in SI units, and what follows from it.
