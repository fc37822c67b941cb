//! What a surface looks like.

use std::sync::Arc;

base::define_id! {
    /// One material of a [`Model`](crate::Model).
    pub struct MaterialId;
}

/// What a material stands for; files carry it in the material's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MaterialKind {
    /// Woody surface.
    Bark,
    /// Woody surface of twigs.
    YoungBark,
    /// Green stem of a herb.
    Stem,
    /// Leaf blade.
    Leaf,
    /// Petal blade.
    Petal,
    /// The disc (centre) of a flower.
    Disc,
    /// Fruit skin.
    Fruit,
    /// Root surface.
    Root,
    /// Stamens and pistil.
    Stamen,
    /// Anything read from a file.
    Other,
}

impl MaterialKind {
    /// The word used in names and reports.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Bark => "bark",
            Self::YoungBark => "bark-young",
            Self::Stem => "stem",
            Self::Leaf => "leaf",
            Self::Petal => "petal",
            Self::Disc => "disc",
            Self::Fruit => "fruit",
            Self::Root => "root",
            Self::Stamen => "stamen",
            Self::Other => "other",
        }
    }
}

/// An sRGB image, rows from the top, 4 bytes a pixel (RGBA). `pixels.len() == 4 * width * height`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texture {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// RGBA bytes.
    pub pixels: Vec<u8>,
}

/// How alpha is read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AlphaMode {
    /// Alpha is ignored.
    #[default]
    Opaque,
    /// A pixel below one half is a hole.
    Mask,
}

/// A physically based material in the glTF sense.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Unique within the model, such as `leaf` or `petal-2`.
    pub name: String,
    /// What it stands for.
    pub kind: MaterialKind,
    /// Linear RGB base colour, each 0 to 1; multiplied by the texture.
    pub base_color: [f32; 3],
    /// 0 (mirror) to 1 (matt).
    pub roughness: f32,
    /// Share of light that passes through a thin blade, 0 to 1 (used by pictures only).
    pub translucency: f32,
    /// Base colour texture.
    pub texture: Option<Arc<Texture>>,
    /// How the texture's alpha is read.
    pub alpha: AlphaMode,
    /// Seen from both sides (blades).
    pub double_sided: bool,
}

impl Material {
    /// A plain, matt, one-sided material.
    pub fn plain(name: impl Into<String>, kind: MaterialKind, base_color: [f32; 3]) -> Self {
        Self {
            name: name.into(),
            kind,
            base_color,
            roughness: 0.9,
            translucency: 0.0,
            texture: None,
            alpha: AlphaMode::Opaque,
            double_sided: false,
        }
    }
}
