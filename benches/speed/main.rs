//! Benchmarks that print ratios measured within one run: `make bench`.

mod fog;
mod record;
mod sky;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    record::run()?;
    fog::run()?;
    sky::run()
}
