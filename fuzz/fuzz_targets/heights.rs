#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| welkin_fuzz::targets::heights(data));
