//! Benchmarks that print ratios from one run: `make bench` (release).

mod record;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    record::run()
}
