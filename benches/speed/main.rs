//! Benchmarks that print ratios measured within one run: `make bench`.

mod record;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    record::run()
}
