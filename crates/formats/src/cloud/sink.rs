//! The collector that readers of clouds fill.

use std::collections::BTreeMap;

use base::Report;
use glam::DVec3;
use mesh::{PointClass, PointCloud};

use super::{FARTHEST, MAX_POINTS};

/// In what numbers a colour is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Coding {
    /// sRGB, 0 to 255.
    Byte,
    /// sRGB, 0 to 65535: the upper byte counts.
    Word,
    /// sRGB, 0 to 1.
    Share,
    /// The share of light that is thrown back, 0 to 1, as multispectral scanners measure it.
    Reflectance,
}

impl Coding {
    /// Returns the range of the colours by their greatest number; `None` beyond 65535, and if all are 0.
    fn shown(greatest: f32, is_whole: bool) -> Option<Self> {
        match greatest {
            g if g <= 0.0 => None,
            g if g <= 1.0 && !is_whole => Some(Self::Share),
            g if g <= 255.0 => Some(Self::Byte),
            g if g <= 65535.0 => Some(Self::Word),
            _ => None,
        }
    }

    /// As sRGB bytes. Numbers beyond the range are its ends.
    pub(super) fn bytes(self, color: [f64; 3]) -> [u8; 3] {
        let srgb = |x: f64| match self {
            Self::Byte => x.trunc(),
            Self::Word => (x / 256.0).trunc(),
            Self::Share => (x * 255.0).round(),
            Self::Reflectance => f64::from(base::byte_of_light(x)),
        };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturation is wanted")]
        color.map(|x| srgb(x) as u8)
    }
}

/// The class of a point, as its file has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Said {
    Class(PointClass),
    /// Not to be used: an echo of dust, rain or a second path.
    Noise,
}

impl Said {
    /// Returns the meaning of a class of LAS, by the numbers of its specification.
    pub(super) const fn from_number(class: u8) -> Self {
        match class {
            // Ground, and the few points of it that suffice (of LAS up to 1.3).
            2 | 8 => Self::Class(PointClass::Ground),
            // Low and high noise.
            7 | 18 => Self::Noise,
            _ => Self::Class(PointClass::Unknown),
        }
    }

    /// Returns the meaning of a word or phrase.
    pub(super) fn from_word(word: &str) -> Option<Self> {
        let word = word.to_ascii_lowercase();
        let has = |words: &[&str]| words.iter().any(|w| word.contains(w));
        if has(&["noise", "outlier"]) {
            return Some(Self::Noise);
        }
        let class = if has(&["leaf", "leaves", "foliage", "needle"]) {
            PointClass::Leaf
        } else if has(&["wood", "stem", "trunk", "branch", "twig"]) {
            PointClass::Wood
        } else if has(&["ground", "terrain"]) {
            PointClass::Ground
        } else {
            return None;
        };
        Some(Self::Class(class))
    }
}

/// A number that is a whole one from 0 to 255.
pub(super) fn byte(x: f64) -> Option<u8> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    ((0.0..=255.0).contains(&x) && x.fract() <= 0.0).then_some(x as u8)
}

/// The points of a cloud as they come, in the unit and the axes of their file.
#[derive(Default)]
pub(super) struct Sink {
    pub(super) cloud: PointCloud,
    /// Colours whose coding is known at the end only.
    raw: Vec<[f32; 3]>,
    /// Colours are of a type of whole numbers, which has no shares.
    pub(super) has_whole_colors: bool,
    /// Not finite, or absurdly far.
    pub(super) dropped: u64,
    /// Noise, by its class, or deleted in their file.
    pub(super) noise: u64,
    pub(super) deleted: u64,
    /// Points of each class that is numbered, left out or not.
    pub(super) numbers: BTreeMap<u8, u64>,
    /// Names that the file gives to classes.
    pub(super) names: BTreeMap<u8, String>,
    /// Names of the columns.
    pub(super) columns: Vec<String>,
    /// The kind of file, more closely.
    pub(super) detail: String,
    /// The coordinate system as the file names it.
    pub(super) system: Option<String>,
    /// Its unit, as the file names it, and metres in it.
    pub(super) unit: Option<(String, f64)>,
    /// The steps in which whole numbers count, in the unit of the file.
    pub(super) step: Option<f64>,
}

impl Sink {
    /// Takes a point in; `false` when there are too many.
    pub(super) fn push(&mut self, p: [f64; 3], color: Option<[u8; 3]>, said: Option<Said>) -> bool {
        if !self.takes(p, said) {
            return true;
        }
        self.cloud.colors.extend(color);
        self.add(p)
    }

    /// [`Self::push`] of a point with a colour in numbers of any range: [`Self::finish`] sees which.
    pub(super) fn push_raw(&mut self, p: [f64; 3], color: [f64; 3], said: Option<Said>) -> bool {
        if !self.takes(p, said) {
            return true;
        }
        #[expect(clippy::cast_possible_truncation, reason = "a colour")]
        self.raw.push(color.map(|x| if x.is_nan() { 0.0 } else { x.clamp(0.0, 1e9) as f32 }));
        self.add(p)
    }

    /// Counts a point whose class is a number.
    pub(super) fn numbered(&mut self, class: u8) -> Said {
        *self.numbers.entry(class).or_default() += 1;
        self.names.get(&class).and_then(|name| Said::from_word(name)).unwrap_or(Said::from_number(class))
    }

    fn takes(&mut self, p: [f64; 3], said: Option<Said>) -> bool {
        if !p.iter().all(|x| x.abs() <= FARTHEST) {
            self.dropped += 1;
            return false;
        }
        match said {
            Some(Said::Noise) => {
                self.noise += 1;
                return false;
            }
            Some(Said::Class(class)) => self.cloud.classes.push(class),
            None => {}
        }
        true
    }

    fn add(&mut self, p: [f64; 3]) -> bool {
        self.cloud.points.push(DVec3::from_array(p));
        self.cloud.points.len() <= MAX_POINTS
    }

    /// Points that came, used or not.
    pub(super) fn seen(&self) -> u64 {
        self.cloud.points.len() as u64 + self.dropped + self.noise + self.deleted
    }

    /// Brings colours into bytes, and leaves out columns that say nothing.
    pub(super) fn finish(&mut self, report: &mut Report) {
        if !self.raw.is_empty() {
            let greatest = self.raw.iter().flatten().copied().fold(0.0, f32::max);
            if greatest > 65535.0 {
                report.warn(
                    "scan-colors",
                    format!("the colours go up to {greatest:e}, which is no range of colours: left out"),
                );
            }
            if let Some(coding) = Coding::shown(greatest, self.has_whole_colors) {
                let bytes = |c: &[f32; 3]| coding.bytes(c.map(f64::from));
                self.cloud.colors = self.raw.iter().map(bytes).collect();
            }
            self.raw = vec![];
        }
        if self.cloud.classes.iter().all(|c| *c == PointClass::Unknown) {
            self.cloud.classes = vec![];
        }
    }
}
