//! The order of passes, composition and the frame's report.
