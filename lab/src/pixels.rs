//! Pictures from which the pages of docs are made.

use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use xtask::shell::Outcome;

/// A picture in memory.
#[derive(Debug)]
pub(crate) struct Pixels {
    /// Pixels, row by row from the top.
    pub(crate) rgba: Vec<[u8; 4]>,
    pub(crate) width: usize,
    pub(crate) height: usize,
}

/// Reads a PNG of 8 bits a channel, with or without transparency.
pub(crate) fn rgba(path: &Path) -> Result<Pixels, String> {
    let fault = |e: &dyn std::fmt::Display| format!("{}: {e}", path.display());
    let file = File::open(path).map_err(|e| fault(&e))?;
    let mut decoder = png::Decoder::new(BufReader::new(file));
    // A picture with a sky comes without alpha.
    decoder.set_transformations(png::Transformations::ALPHA);
    let mut reader = decoder.read_info().map_err(|e| fault(&e))?;
    let mut bytes = vec![0; reader.output_buffer_size().ok_or_else(|| fault(&"is too large"))?];
    let info = reader.next_frame(&mut bytes).map_err(|e| fault(&e))?;
    if info.color_type != png::ColorType::Rgba || info.bit_depth != png::BitDepth::Eight {
        return Err(fault(&"is not RGBA of 8 bits"));
    }
    let (rgba, _) = bytes.as_chunks::<4>();
    Ok(Pixels { rgba: rgba.to_vec(), width: info.width as usize, height: info.height as usize })
}

/// Returns a width or height in the form of a PNG's header.
pub(crate) fn length(pixels: usize) -> u32 {
    u32::try_from(pixels).unwrap_or(u32::MAX)
}

/// Joins pictures of one size in rows, one row below another.
pub(crate) fn tiled(rows: &[Vec<PathBuf>], to: &Path) -> Outcome {
    let mut pixels: Vec<u8> = Vec::new();
    let (mut width, mut height) = (0, 0);
    for row in rows {
        let read = row.iter().map(|p| rgba(p)).collect::<Result<Vec<_>, _>>()?;
        let Some((wide, high)) = read.first().map(|r| (r.width, r.height)) else { continue };
        width = wide * read.len();
        height += high;
        for y in 0..high {
            for Pixels { rgba, width, .. } in &read {
                rgba[width * y..width * (y + 1)].iter().for_each(|c| pixels.extend(&c[..3]));
            }
        }
    }
    write(&pixels, width, height, to)
}

/// Writes colours without transparency, row by row from the top.
pub(crate) fn write_rgb(pixels: &[[u8; 3]], width: usize, height: usize, to: &Path) -> Outcome {
    write(pixels.as_flattened(), width, height, to)
}

fn write(pixels: &[u8], width: usize, height: usize, to: &Path) -> Outcome {
    let fault = |e: &dyn std::fmt::Display| format!("{}: {e}", to.display());
    let out = File::create(to).map_err(|e| fault(&e))?;
    let mut encoder = png::Encoder::new(std::io::BufWriter::new(out), length(width), length(height));
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header().map_err(|e| fault(&e))?;
    writer.write_image_data(pixels).map_err(|e| fault(&e))?;
    writer.finish().map_err(|e| fault(&e))
}
