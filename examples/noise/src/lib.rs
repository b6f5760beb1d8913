//! Creates noise textures from a command line, with the library's own noise.

use std::path::Path;

use welkin::gpu::{Device, DeviceOptions};
use welkin::noise::{CloudFunction, CloudPreset, NoiseImage, NoiseKind, NoiseSettings, NoiseTexture};
use welkin::{Error, Result, Status};

/// Usage text with every option.
pub const USAGE: &str = "usage: noise FILE.dds|FILE.ktx2|FILE.png.. [--kind gradient|cellular|both]\n       \
                     [--size WIDTHxHEIGHT[xDEPTH]] [--frequency CELLS[,CELLS[,CELLS]]] [--octaves N] [--amplitude A]\n       \
                     [--persistence P] [--seed N] [--preset overcast|broken|few] [--from FILE] [--gpu]\n       \
                     [--cutoff C | --cover SHARE] [--density D] [--slice Z] [--tiles N]\n       \
                     noise --help | --version";

/// Longest side of a preview, pixels.
const LONGEST_PREVIEW: u64 = 16384;

/// Options that take a value.
const OPTIONS: [&str; 14] = [
    "--kind",
    "--size",
    "--frequency",
    "--octaves",
    "--amplitude",
    "--persistence",
    "--seed",
    "--preset",
    "--from",
    "--cutoff",
    "--cover",
    "--density",
    "--slice",
    "--tiles",
];

/// The options of a command line.
struct Job {
    files: Vec<String>,
    size: [u32; 3],
    noise: NoiseSettings,
    from: Option<String>,
    gpu: bool,
    cutoff: Option<f64>,
    cover: Option<f64>,
    density: Option<f64>,
    slice: u32,
    tiles: u32,
}

fn usage(what: impl std::fmt::Display) -> Error {
    Error::new(Status::Parse, format!("{what}\n{USAGE}"))
}

fn number<T: std::str::FromStr>(name: &str, text: &str) -> Result<T> {
    text.parse().map_err(|_| usage(format_args!("{name} cannot be `{text}`")))
}

/// Parses up to three numbers separated by `mark`. Missing numbers are `rest`, or repeat the last one.
fn three(name: &str, text: &str, mark: char, rest: Option<u32>) -> Result<[u32; 3]> {
    let given = text.split(mark).map(|n| number(name, n)).collect::<Result<Vec<u32>>>()?;
    let last = rest.or(given.last().copied());
    match (given.len(), last) {
        (1..=3, Some(last)) => Ok([0, 1, 2].map(|i| given.get(i).copied().unwrap_or(last))),
        _ => Err(usage(format_args!("{name} cannot be `{text}`"))),
    }
}

impl Job {
    fn parse(mut words: impl Iterator<Item = String>) -> Result<Self> {
        let mut job = Self {
            files: Vec::new(),
            size: [512, 512, 1],
            noise: NoiseSettings::default(),
            from: None,
            gpu: false,
            cutoff: None,
            cover: None,
            density: None,
            slice: 0,
            tiles: 1,
        };
        while let Some(word) = words.next() {
            if word == "--gpu" {
                job.gpu = true;
            } else if word.starts_with('-') {
                if !OPTIONS.contains(&word.as_str()) {
                    return Err(usage(format_args!("unknown option `{word}`")));
                }
                let value = words.next().ok_or_else(|| usage(format_args!("{word} has no value")))?;
                job.set(&word, &value)?;
            } else {
                job.files.push(word);
            }
        }
        if job.files.is_empty() {
            return Err(usage("no file to write"));
        }
        Ok(job)
    }

    fn set(&mut self, name: &str, value: &str) -> Result<()> {
        match name {
            "--kind" => {
                self.noise.kind = match value {
                    "gradient" => NoiseKind::Gradient,
                    "cellular" => NoiseKind::Cellular,
                    "both" => NoiseKind::GradientOverCellular,
                    other => return Err(usage(format_args!("there is no kind `{other}`"))),
                }
            }
            "--size" => self.size = three(name, value, 'x', Some(1))?,
            "--frequency" => self.noise.frequency = three(name, value, ',', None)?,
            "--octaves" => self.noise.octaves = number(name, value)?,
            "--amplitude" => self.noise.amplitude = number(name, value)?,
            "--persistence" => self.noise.persistence = number(name, value)?,
            "--seed" => self.noise.seed = number(name, value)?,
            "--preset" => {
                let preset = CloudPreset::from_name(value);
                let preset = preset.ok_or_else(|| usage(format_args!("there is no preset `{value}`")))?;
                (self.size, self.noise) = (CloudPreset::SIZE, preset.noise(self.noise.seed));
                let (cutoff, density) = preset.cutoff_and_density();
                (self.cutoff, self.density) = (Some(cutoff), Some(density));
            }
            "--from" => self.from = Some(value.into()),
            "--cutoff" => (self.cutoff, self.cover) = (Some(number(name, value)?), None),
            "--cover" => (self.cover, self.cutoff) = (Some(number(name, value)?), None),
            "--density" => self.density = Some(number(name, value)?),
            "--slice" => self.slice = number(name, value)?,
            "--tiles" => self.tiles = number::<u32>(name, value)?.clamp(1, 8),
            other => return Err(usage(format_args!("unknown option `{other}`"))),
        }
        Ok(())
    }

    fn noise(&self) -> Result<NoiseImage> {
        if let Some(from) = &self.from {
            return NoiseImage::load(from);
        }
        if self.gpu {
            let device = Device::headless(&DeviceOptions::default())?;
            return NoiseTexture::generate(&device, self.size, &[self.noise])?.read(&device, 0);
        }
        NoiseImage::generate(self.size, &self.noise)
    }

    /// The function that cuts clouds out of the noise, if requested.
    fn cloud(&self, noise: &NoiseImage) -> Result<Option<CloudFunction>> {
        let cutoff = match (self.cover, self.cutoff) {
            (Some(cover), _) => noise.cutoff_for_cover(cover)?,
            (None, Some(cutoff)) => cutoff,
            (None, None) => return Ok(None),
        };
        CloudFunction::from_density(cutoff, self.density.unwrap_or(0.96)).map(Some)
    }

    /// Writes the files and returns a description of their contents.
    fn run(&self) -> Result<String> {
        let noise = self.noise()?;
        let cloud = self.cloud(&noise)?;
        let image = match &cloud {
            Some(cloud) => noise.opacities(cloud)?,
            None => noise.clone(),
        };
        // Computes all contents before writing the first file.
        let contents =
            self.files.iter().map(|f| self.content(f, &image, cloud.is_some())).collect::<Result<Vec<_>>>()?;
        for (file, content) in self.files.iter().zip(contents) {
            welkin_command_line::write_whole(Path::new(file), &content)?;
        }
        let bytes = &noise.levels()[0];
        let mean = bytes.iter().map(|n| f64::from(*n)).sum::<f64>() / 255.0 / bytes.len() as f64;
        let [low, high] = [bytes.iter().min(), bytes.iter().max()].map(|n| n.copied().unwrap_or(0));
        let [width, height, depth] = noise.size();
        let mut said = format!("size {width} x {height} x {depth}, mean {mean:.3}, from {low} to {high}");
        if let Some(cloud) = &cloud {
            said += &format!("\ncutoff {:.4}, cover {:.3}", cloud.cutoff(), noise.cover(cloud.cutoff()));
        }
        Ok(said)
    }

    fn content(&self, file: &str, image: &NoiseImage, is_cloud: bool) -> Result<Vec<u8>> {
        match Path::new(file).extension().and_then(|e| e.to_str()) {
            Some("dds") => Ok(image.to_dds()),
            Some("ktx2") => Ok(image.to_ktx2()),
            Some("png") => self.preview(image, is_cloud),
            _ => Err(usage(format_args!("`{file}` ends in none of .dds, .ktx2 and .png"))),
        }
    }

    /// Tiles of a slice side by side: grey, or white clouds on a blue sky.
    fn preview(&self, image: &NoiseImage, is_cloud: bool) -> Result<Vec<u8>> {
        let slices = image.size()[2];
        let slice = image.preview(self.slice);
        let slice = slice.ok_or_else(|| usage(format_args!("--slice {} of {slices}", self.slice)))?;
        let [width, height, _] = image.size();
        let edge = u64::from(width.max(height)) * u64::from(self.tiles);
        if edge > LONGEST_PREVIEW {
            return Err(usage(format_args!("a preview of {edge} pixels is longer than {LONGEST_PREVIEW}")));
        }
        let shade = |value: u8| {
            let over = |sky: u16| ((sky * (255 - u16::from(value)) + 255 * u16::from(value)) / 255) as u8;
            if is_cloud { [over(70), over(120), over(190)] } else { [value; 3] }
        };
        let picture = image::RgbImage::from_fn(width * self.tiles, height * self.tiles, |x, y| {
            image::Rgb(shade(slice[((y % height) * width + x % width) as usize]))
        });
        let mut png = std::io::Cursor::new(Vec::new());
        let failed = |e| Error::new(Status::Io, format!("writing the preview: {e}"));
        picture.write_to(&mut png, image::ImageFormat::Png).map_err(failed)?;
        Ok(png.into_inner())
    }
}

/// Runs a command line without its first word, and returns a description of the files.
///
/// # Errors
/// Wrong arguments; files; the GPU.
pub fn run(words: impl Iterator<Item = String>) -> Result<String> {
    Job::parse(words)?.run()
}
