//! Benchmarks that print ratios measured within one run: `make bench`.

mod fog;
mod record;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    record::run()?;
    fog::run()
}
