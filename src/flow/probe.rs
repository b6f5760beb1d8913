//! Asks the field from outside.
