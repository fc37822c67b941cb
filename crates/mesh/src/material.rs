//! Appearance of surfaces.

use std::sync::Arc;

base::define_id! {
    /// One material of a [`Model`](crate::Model).
    pub struct MaterialId;
}

/// Kind of surface; files carry it in the material's name.
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
    /// Returns the word for names and reports.
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

impl Texture {
    /// Joins square pictures of `size` pixels a side, RGBA bytes, row by row in a square of `cells` by `cells`, which
    /// is 1 or more; further pictures are left out, and empty cells are 0.
    ///
    /// ```
    /// let (red, blue) = ([255, 0, 0, 255], [0, 0, 255, 255]);
    /// let all = mesh::Texture::joined([&red[..], &blue, &red].into_iter(), 1, 2);
    /// assert_eq!((all.width, all.pixels), (2, [red, blue, red, [0; 4]].concat()));
    /// ```
    pub fn joined<'a>(pictures: impl Iterator<Item = &'a [u8]>, size: u32, cells: u32) -> Self {
        let side = size * cells;
        let (line, stride, columns) = (4 * size as usize, 4 * side as usize, cells as usize);
        let mut pixels = vec![0; stride * side as usize];
        for (k, picture) in pictures.take(columns * columns).enumerate() {
            let corner = k / columns * size as usize * stride + k % columns * line;
            for (y, part) in picture.chunks_exact(line).enumerate() {
                let at = corner + y * stride;
                pixels[at..at + line].copy_from_slice(part);
            }
        }
        Self { width: side, height: side, pixels }
    }
}

/// Textures of a surface in addition to its colour, each over the texture coordinates of the mesh. Default: none.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Maps {
    /// Normals in the space of the tangent as glTF has them: red along u, green against v, blue outwards; the
    /// material's tangents are those that `MikkTSpace` computes.
    pub normal: Option<Arc<Texture>>,
    /// Red: share of the sky that is visible (1 all). Green: factor of the roughness. Blue: 0, no metal.
    pub orm: Option<Arc<Texture>>,
    /// Grey: height of the relief, 0 its lowest and 255 its highest place.
    pub height: Option<Arc<Texture>>,
    /// Alpha: factor of the translucency.
    pub through: Option<Arc<Texture>>,
}

impl Maps {
    /// Returns all textures, in the order of the fields.
    pub fn each(&self) -> impl Iterator<Item = &Arc<Texture>> {
        [&self.normal, &self.orm, &self.height, &self.through].into_iter().flatten()
    }
}

/// Meaning of the alpha channel.
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
    /// Kind of surface.
    pub kind: MaterialKind,
    /// Linear RGB base colour, each 0 to 1; multiplied by the texture.
    pub base_color: [f32; 3],
    /// 0 (mirror) to 1 (matt).
    pub roughness: f32,
    /// Share of light that passes through a thin blade, 0 to 1.
    pub translucency: f32,
    /// Base colour texture.
    pub texture: Option<Arc<Texture>>,
    /// Normals, occlusion and roughness, height, translucency.
    pub maps: Maps,
    /// Meaning of the texture's alpha.
    pub alpha: AlphaMode,
    /// Visible from both sides (blades).
    pub double_sided: bool,
    /// Its textures are views of a whole plant from many sides.
    pub impostor: Option<Impostor>,
}

/// Views of a plant from all sides above the ground, in a square of `frames` by `frames` pictures: the one in column
/// i and row j is seen from the direction of (x, y) = (2 i / (frames - 1) - 1, 2 j / (frames - 1) - 1) on the half
/// octahedron ((x + y) / 2, 1 - |x + y| / 2 - |x - y| / 2, (x - y) / 2). Each shows the sphere around `centre`,
/// without perspective, with the vertical upwards. Normals are in the frame of the view: red to the right, green up,
/// blue to the viewer. The alpha of the normals is the depth: 0 at the back of the sphere, 1 at its front.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impostor {
    /// Pictures along a side, 2 or more.
    pub frames: u32,
    /// Centre of the sphere, metres.
    pub centre: [f32; 3],
    /// Radius of the sphere, metres.
    pub radius_m: f32,
}

impl Material {
    /// Returns a plain, matt, one-sided material.
    pub fn plain(name: impl Into<String>, kind: MaterialKind, base_color: [f32; 3]) -> Self {
        Self {
            name: name.into(),
            kind,
            base_color,
            roughness: 0.9,
            translucency: 0.0,
            texture: None,
            maps: Maps::default(),
            alpha: AlphaMode::Opaque,
            double_sided: false,
            impostor: None,
        }
    }
}
