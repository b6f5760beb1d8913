//! The C boundary and nothing else: checks, conversion, panic and error handling.
