//! A grid of heights: `PNG or GeoTIFF -> heights -> height and normal anywhere`.

use std::io::Cursor;

use base::{Counted, Run};
use glam::{DVec2, DVec3};
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

use super::{GroundError, png_gray};

/// Scale of the grey levels of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapScale {
    /// Side of a cell in metres, above 0.
    pub metres_per_cell: f64,
    /// Height of level 0, metres.
    pub low_m: f64,
    /// Height of level 65,535, metres.
    pub high_m: f64,
    /// The level of cells without data, if there is one.
    pub no_data: Option<u16>,
}

/// Heights at the centres of square cells, bilinear between.
///
/// Rows go from north (-Z) to south, columns from west (-X) to east. A place has a height if the four cells around it
/// have data; so the outermost half of each cell at the edge is outside.
///
/// ```
/// use glam::DVec2;
/// let map = forest::HeightMap::new(2, vec![0.0, 1.0, 2.0, 3.0], DVec2::ONE, DVec2::ZERO)?;
/// assert_eq!(forest::Ground::Map(map).height_m(0.5, 0.5), Some(1.5));
/// # Ok::<(), forest::GroundError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct HeightMap {
    columns: usize,
    rows: usize,
    /// Heights, metres; NaN for no data.
    heights_m: Vec<f32>,
    cell_m: DVec2,
    /// Centre of the first cell: x and z.
    first: DVec2,
}

/// Splits a coordinate into a cell and the share within it; the share stays below 1, so that a place on the very edge
/// lies in a cell.
fn split(at: f64, count: usize) -> Option<(usize, f64)> {
    let last = count.checked_sub(2)?;
    if !(0.0..=(last + 1) as f64).contains(&at) {
        return None;
    }
    let cell = (base::ops::whole(at) as usize).min(last);
    Some((cell, at - cell as f64))
}

impl HeightMap {
    /// Builds a map from heights in metres, row by row; NaN for no data. `cell_m`: sides of a cell; `first`: x and z
    /// of the centre of the first cell.
    ///
    /// # Errors
    /// [`GroundError`]: fewer than two rows or columns, rows that are not full, sides that are not above 0, or no
    /// data at all.
    pub fn new(
        columns: usize,
        heights_m: Vec<f32>,
        cell_m: DVec2,
        first: DVec2,
    ) -> Result<Self, GroundError> {
        let rows = heights_m.len() / columns.max(1);
        if columns < 2 || rows < 2 {
            return Err(GroundError::TooSmall("height map", "two rows and two columns"));
        }
        if rows * columns != heights_m.len() {
            return Err(GroundError::Numbers("heights do not fill whole rows"));
        }
        if !(cell_m.min_element() > 0.0 && cell_m.is_finite() && first.is_finite()) {
            return Err(GroundError::Numbers("cells must have sides above 0 m, at a finite place"));
        }
        if heights_m.iter().all(|h| !h.is_finite()) {
            return Err(GroundError::NoData);
        }
        Ok(Self { columns, rows, heights_m, cell_m, first })
    }

    /// Reads a picture of 16 bits of grey, with its centre at the origin.
    ///
    /// # Errors
    /// [`GroundError`]: no such picture, 8 bits, too large, or a scale that gives no ground.
    pub fn from_png(bytes: &[u8], scale: &MapScale, run: &Run<'_>) -> Result<Self, GroundError> {
        let MapScale { metres_per_cell: side, low_m, high_m, no_data } = *scale;
        if !(side > 0.0 && side.is_finite() && low_m.is_finite() && high_m.is_finite()) {
            return Err(GroundError::Numbers("scale must be finite, and its cells above 0 m"));
        }
        let gray = png_gray::read(bytes, true, run)?;
        let height = |level: u16| {
            if Some(level) == no_data {
                return f32::NAN;
            }
            #[expect(clippy::cast_possible_truncation, reason = "columns of heights are single floats")]
            let height = base::ops::lerp(low_m, high_m, f64::from(level) / f64::from(u16::MAX)) as f32;
            height
        };
        let heights = (0..gray.width * gray.height).map(|k| height(gray.level(k))).collect();
        let size = DVec2::new(gray.width as f64 - 1.0, gray.height as f64 - 1.0);
        Self::new(gray.width, heights, DVec2::splat(side), -0.5 * side * size)
    }

    /// Reads a GeoTIFF of heights in metres, in a projection in metres: whole numbers or floats, in strips or tiles,
    /// plain, deflated or LZW. `origin_m`: easting and northing of the origin,
    /// [`Stand::origin_m`](crate::Stand::origin_m) of an inventory; none: the centre of the map, rounded to metres,
    /// which is returned with the map.
    ///
    /// # Errors
    /// [`GroundError`]: no such picture, 8 bits, a map in degrees, rotated, or one without scale and place.
    pub fn from_geotiff(
        bytes: &[u8],
        origin_m: Option<DVec2>,
        run: &Run<'_>,
    ) -> Result<(Self, DVec2), GroundError> {
        let fault = |e: tiff::TiffError| GroundError::Unreadable("height map", base::brief(&e.to_string()));
        let most = usize::try_from(run.budget.bytes()).unwrap_or(usize::MAX);
        let mut limits = Limits::default();
        (limits.decoding_buffer_size, limits.intermediate_buffer_size) = (most, most);
        let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(fault)?.with_limits(limits);
        let (width, height) = decoder.dimensions().map_err(fault)?;
        run.budget.check(
            Counted::Cells,
            u64::from(width) * u64::from(height),
            "take larger cells, or a cut-out",
        )?;
        let place = Placement::read(&mut decoder)?;
        let no_data = decoder.get_tag_ascii_string(Tag::GdalNodata).ok();
        let no_data = no_data.and_then(|t| t.trim_matches(['\0', ' ']).parse::<f64>().ok());
        if !matches!(decoder.colortype().map_err(fault)?, tiff::ColorType::Gray(16..)) {
            let color = decoder.colortype().map_err(fault)?;
            return Err(GroundError::Depth(format!("cells of the kind {color:?}")));
        }
        let heights = floats(decoder.read_image().map_err(fault)?, no_data)?;
        let size = DVec2::new(f64::from(width), f64::from(height)) - DVec2::ONE;
        let corner = place.first;
        let middle = (corner + 0.5 * place.cell * size * DVec2::new(1.0, -1.0)).round();
        let origin = origin_m.unwrap_or(middle);
        let first = DVec2::new(corner.x - origin.x, origin.y - corner.y);
        if heights.len() != width as usize * height as usize {
            return Err(GroundError::Unreadable("height map", "cells are missing at its end".into()));
        }
        Ok((Self::new(width as usize, heights, place.cell, first)?, origin))
    }

    /// Returns height and normal; none outside, and next to a cell without data.
    pub(super) fn sample(&self, x: f64, z: f64) -> Option<(f64, DVec3)> {
        let at = (DVec2::new(x, z) - self.first) / self.cell_m;
        let (column, u) = split(at.x, self.columns)?;
        let (row, v) = split(at.y, self.rows)?;
        let height = |r: usize, c: usize| f64::from(self.heights_m[(row + r) * self.columns + column + c]);
        let [[a, b], [c, d]] = [[height(0, 0), height(0, 1)], [height(1, 0), height(1, 1)]];
        let (north, south) = (base::ops::lerp(a, b, u), base::ops::lerp(c, d, u));
        let slope_x = base::ops::lerp(b - a, d - c, v) / self.cell_m.x;
        let slope_z = (south - north) / self.cell_m.y;
        let height = base::ops::lerp(north, south, v);
        height.is_finite().then(|| (height, DVec3::new(-slope_x, 1.0, -slope_z).normalize()))
    }

    /// Returns the least and the greatest x and z that have a height.
    pub fn extent_m(&self) -> [DVec2; 2] {
        let size = DVec2::new((self.columns - 1) as f64, (self.rows - 1) as f64);
        [self.first, self.first + size * self.cell_m]
    }
}

/// Place of a GeoTIFF.
struct Placement {
    cell: DVec2,
    /// Easting and northing of the centre of the first cell.
    first: DVec2,
}

/// Key of the type of coordinates in the GeoTIFF directory (OGC 19-008r4).
const MODEL_TYPE: u16 = 1024;
/// Its value for longitude and latitude.
const GEOGRAPHIC: u16 = 2;
/// Key of the meaning of a cell's position (OGC 19-008r4).
const RASTER_TYPE: u16 = 1025;
/// Its value for points rather than areas.
const PIXEL_IS_POINT: u16 = 2;
/// Least side of a cell of a projection in metres; the cells of a map in degrees are smaller.
const LEAST_CELL: f64 = 0.005;

impl Placement {
    fn read(decoder: &mut Decoder<Cursor<&[u8]>>) -> Result<Self, GroundError> {
        let keys = decoder.get_tag_u16_vec(Tag::GeoKeyDirectoryTag).unwrap_or_default();
        let key = |id: u16| keys.chunks_exact(4).skip(1).find(|k| k[0] == id && k[1] == 0).map(|k| k[3]);
        let in_degrees = "is in degrees: reproject it to metres, such as UTM";
        if key(MODEL_TYPE) == Some(GEOGRAPHIC) {
            return Err(GroundError::Placement(in_degrees));
        }
        let scale = decoder.get_tag_f64_vec(Tag::ModelPixelScaleTag).unwrap_or_default();
        let tie = decoder.get_tag_f64_vec(Tag::ModelTiepointTag).unwrap_or_default();
        let ([sx, sy, ..], [i, j, _, x, y, ..]) = (&scale[..], &tie[..]) else {
            let is_turned = decoder.get_tag_f64_vec(Tag::ModelTransformationTag).is_ok();
            return Err(GroundError::Placement(if is_turned {
                "is turned against north: resample it to rows from west to east"
            } else {
                "does not say its scale and place (ModelPixelScale, ModelTiepoint)"
            }));
        };
        let cell = DVec2::new(*sx, *sy);
        if !(cell.is_finite() && cell.min_element() > 0.0 && x.is_finite() && y.is_finite()) {
            return Err(GroundError::Numbers("cells must have sides above 0 m, at a finite place"));
        }
        if cell.max_element() < LEAST_CELL {
            return Err(GroundError::Placement(in_degrees));
        }
        let half = if key(RASTER_TYPE) == Some(PIXEL_IS_POINT) { 0.0 } else { 0.5 };
        let first = DVec2::new(x + (half - i) * cell.x, y - (half - j) * cell.y);
        Ok(Self { cell, first })
    }
}

/// Returns heights as floats, NaN for no data.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "columns of heights are single floats: a millimetre at ten kilometres"
)]
fn floats(read: DecodingResult, no_data: Option<f64>) -> Result<Vec<f32>, GroundError> {
    let keep = |v: f64| {
        let is_none = !v.is_finite() || no_data.is_some_and(|n| (v - n).abs() <= 1e-6 * n.abs());
        if is_none { f32::NAN } else { v as f32 }
    };
    Ok(match read {
        DecodingResult::U16(v) => v.into_iter().map(|v| keep(f64::from(v))).collect(),
        DecodingResult::I16(v) => v.into_iter().map(|v| keep(f64::from(v))).collect(),
        DecodingResult::U32(v) => v.into_iter().map(|v| keep(f64::from(v))).collect(),
        DecodingResult::I32(v) => v.into_iter().map(|v| keep(f64::from(v))).collect(),
        DecodingResult::U64(v) => v.into_iter().map(|v| keep(v as f64)).collect(),
        DecodingResult::I64(v) => v.into_iter().map(|v| keep(v as f64)).collect(),
        DecodingResult::F32(v) => v.into_iter().map(|v| keep(f64::from(v))).collect(),
        DecodingResult::F64(v) => v.into_iter().map(keep).collect(),
        _ => return Err(GroundError::Depth("8 bits, or floats of 16".into())),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Ground;
    use tiff::encoder::{TiffEncoder, colortype};

    fn png(width: u32, depth: png::BitDepth, bytes: &[u8]) -> Vec<u8> {
        let mut out = Vec::new();
        let bytes_a_cell = if depth == png::BitDepth::Sixteen { 2 } else { 1 };
        let height = u32::try_from(bytes.len()).unwrap() / bytes_a_cell / width;
        let mut encoder = png::Encoder::new(&mut out, width, height);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(depth);
        encoder.write_header().unwrap().write_image_data(bytes).unwrap();
        out
    }

    const SCALE: MapScale =
        MapScale { metres_per_cell: 10.0, low_m: 100.0, high_m: 165.535, no_data: Some(0) };

    #[test]
    fn a_plane_is_a_plane() {
        // y = 3 + 0.5 x - 0.25 z.
        let at = |c: u8, r: u8| 3.0 + 0.5 * f32::from(c) - 0.25 * f32::from(r);
        let heights = (0..12).map(|k| at(k % 4, k / 4)).collect();
        let ground = Ground::Map(HeightMap::new(4, heights, DVec2::ONE, DVec2::ZERO).unwrap());
        for (x, z) in [(0.0, 0.0), (1.25, 0.75), (3.0, 2.0), (2.9, 0.1)] {
            let height = ground.height_m(x, z).unwrap();
            assert!((height - (3.0 + 0.5 * x - 0.25 * z)).abs() < 1e-6, "{x} {z} {height}");
            let normal = ground.normal(x, z).unwrap();
            assert!(normal.distance(DVec3::new(-0.5, 1.0, 0.25).normalize()) < 1e-6);
        }
        for (x, z) in [(-0.01, 0.0), (0.0, 2.01), (f64::NAN, 0.0), (1e300, 0.0)] {
            assert_eq!(ground.height_m(x, z), None);
        }
    }

    #[test]
    fn a_picture_of_sixteen_bits() {
        let levels = [1000_u16, 2000, 3000, 4000, 5000, 0];
        let bytes: Vec<u8> = levels.iter().flat_map(|l| l.to_be_bytes()).collect();
        let map =
            HeightMap::from_png(&png(3, png::BitDepth::Sixteen, &bytes), &SCALE, &Run::plain()).unwrap();
        assert_eq!(map.extent_m(), [DVec2::new(-10.0, -5.0), DVec2::new(10.0, 5.0)]);
        let ground = Ground::Map(map);
        // A level is a millimetre.
        assert!((ground.height_m(-10.0, -5.0).unwrap() - 101.0).abs() < 1e-4);
        assert!((ground.height_m(-5.0, 0.0).unwrap() - 103.0).abs() < 1e-4);
        assert_eq!(ground.height_m(5.0, 0.0), None, "next to a cell without data");
    }

    #[test]
    fn wrong_pictures_are_refused() {
        let eight = png(3, png::BitDepth::Eight, &[1; 6]);
        let fault = HeightMap::from_png(&eight, &SCALE, &Run::plain()).unwrap_err().to_string();
        assert!(fault.contains("8 bits of grey") && fault.contains("Save it with 16 bits"), "{fault}");
        let deep = png(3, png::BitDepth::Sixteen, &[0; 12]);
        assert_eq!(HeightMap::from_png(&deep, &SCALE, &Run::plain()), Err(GroundError::NoData));
        for bytes in [&b""[..], b"\x89PNG", &deep[..40]] {
            assert!(HeightMap::from_png(bytes, &SCALE, &Run::plain()).is_err());
            assert!(HeightMap::from_geotiff(bytes, None, &Run::plain()).is_err());
        }
        let budget = base::Budget { times: 1e-8, ..base::Budget::default() };
        let small = Run { budget, ..Run::plain() };
        assert!(matches!(HeightMap::from_png(&deep, &SCALE, &small), Err(GroundError::OverBudget(_))));
    }

    fn geotiff(tags: &[(Tag, &[f64])], keys: &[u16], heights: &[f32]) -> Vec<u8> {
        let mut out = Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut out).unwrap();
        let mut image = encoder.new_image::<colortype::Gray32Float>(3, 2).unwrap();
        for (tag, values) in tags {
            image.encoder().write_tag(*tag, *values).unwrap();
        }
        if !keys.is_empty() {
            image.encoder().write_tag(Tag::GeoKeyDirectoryTag, keys).unwrap();
        }
        image.encoder().write_tag(Tag::GdalNodata, "-9999").unwrap();
        image.write_data(heights).unwrap();
        out.into_inner()
    }

    #[test]
    fn a_geotiff_lies_where_it_says() {
        let scale = (Tag::ModelPixelScaleTag, &[2.0, 2.0, 0.0][..]);
        let tie = (Tag::ModelTiepointTag, &[0.0, 0.0, 0.0, 500_000.0, 5_400_000.0, 0.0][..]);
        let heights = [10.0, 11.0, 12.0, 20.0, 21.0, -9999.0];
        let bytes = geotiff(&[scale, tie], &[], &heights);
        // Cells are areas: the first has its centre a metre from the corner.
        let (map, origin) = HeightMap::from_geotiff(&bytes, None, &Run::plain()).unwrap();
        assert_eq!(origin, DVec2::new(500_003.0, 5_399_998.0));
        let ground = Ground::Map(map);
        assert_eq!(ground.height_m(-2.0, -1.0), Some(10.0));
        assert_eq!(ground.height_m(-1.0, 0.0), Some(15.5));
        assert_eq!(ground.height_m(1.0, 0.0), None);
        let at = DVec2::new(500_001.0, 5_399_999.0);
        let (map, _) = HeightMap::from_geotiff(&bytes, Some(at), &Run::plain()).unwrap();
        assert_eq!(Ground::Map(map).height_m(0.0, 0.0), Some(10.0));
        let point = geotiff(&[scale, tie], &[1, 1, 0, 1, RASTER_TYPE, 0, 1, PIXEL_IS_POINT], &heights);
        let at = DVec2::new(500_000.0, 5_400_000.0);
        let (map, _) = HeightMap::from_geotiff(&point, Some(at), &Run::plain()).unwrap();
        assert_eq!(Ground::Map(map).height_m(0.0, 0.0), Some(10.0));
    }

    #[test]
    fn a_geotiff_in_degrees_or_without_a_place_is_refused() {
        let tie = (Tag::ModelTiepointTag, &[0.0, 0.0, 0.0, 11.0, 48.0, 0.0][..]);
        let degrees = geotiff(&[(Tag::ModelPixelScaleTag, &[3e-4, 3e-4, 0.0]), tie], &[], &[1.0; 6]);
        let said = HeightMap::from_geotiff(&degrees, None, &Run::plain()).unwrap_err().to_string();
        assert!(said.contains("in degrees"), "{said}");
        let keys = [1, 1, 0, 1, MODEL_TYPE, 0, 1, GEOGRAPHIC];
        let degrees = geotiff(&[(Tag::ModelPixelScaleTag, &[1.0, 1.0, 0.0]), tie], &keys, &[1.0; 6]);
        assert!(HeightMap::from_geotiff(&degrees, None, &Run::plain()).is_err());
        let nowhere = geotiff(&[], &[], &[1.0; 6]);
        let said = HeightMap::from_geotiff(&nowhere, None, &Run::plain()).unwrap_err().to_string();
        assert!(said.contains("does not say"), "{said}");
    }
}
