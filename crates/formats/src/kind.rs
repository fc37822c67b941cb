//! What kind of file it is: by its name, by its first bytes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The file formats that hold scans.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CloudFormat {
    /// Polygon file format, text or binary; faces are left out.
    Ply,
    /// One point a line: x y z and more columns, separated by spaces, commas or semicolons.
    Xyz,
    /// Point cloud data of PCL, text, binary or compressed.
    Pcd,
    /// LAS 1.0 to 1.4, uncompressed.
    Las,
    /// Vertices of a Wavefront OBJ; faces are left out.
    Obj,
}

impl CloudFormat {
    /// Every format.
    pub const ALL: [Self; 5] = [Self::Ply, Self::Xyz, Self::Pcd, Self::Las, Self::Obj];

    /// The name for messages.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Ply => "PLY",
            Self::Xyz => "XYZ",
            Self::Pcd => "PCD",
            Self::Las => "LAS",
            Self::Obj => "OBJ",
        }
    }

    /// The format that a file's extension (without the dot, any case) stands for.
    ///
    /// ```
    /// use formats::CloudFormat;
    /// assert_eq!(CloudFormat::from_extension("TXT"), Some(CloudFormat::Xyz));
    /// ```
    pub fn from_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "ply" => Some(Self::Ply),
            "xyz" | "txt" | "csv" | "asc" | "pts" | "xyzn" | "xyzrgb" => Some(Self::Xyz),
            "pcd" => Some(Self::Pcd),
            "las" | "laz" => Some(Self::Las),
            "obj" => Some(Self::Obj),
            _ => None,
        }
    }
}

/// The file formats that hold strokes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum DrawingFormat {
    /// Scalable Vector Graphics; one drawing a file.
    Svg,
    /// Ink Markup Language (W3C 2011); one drawing a file.
    InkMl,
    /// One JSON object a line, as in "Quick, Draw!"; any number of drawings a file.
    Ndjson,
    /// Our own `drawing/1`; one drawing a file.
    Json,
    /// Excalidraw's files and what it puts on the clipboard; one drawing a file.
    Excalidraw,
    /// tldraw's files; one drawing a file.
    Tldraw,
}

impl DrawingFormat {
    /// Every format.
    pub const ALL: [Self; 6] =
        [Self::Svg, Self::InkMl, Self::Ndjson, Self::Json, Self::Excalidraw, Self::Tldraw];

    /// The name for messages.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Svg => "SVG",
            Self::InkMl => "InkML",
            Self::Ndjson => "ndjson",
            Self::Json => "drawing JSON",
            Self::Excalidraw => "Excalidraw",
            Self::Tldraw => "tldraw",
        }
    }

    /// The format that a file's extension (without the dot, any case) stands for.
    ///
    /// ```
    /// use formats::DrawingFormat;
    /// assert_eq!(DrawingFormat::from_extension("SVG"), Some(DrawingFormat::Svg));
    /// assert_eq!(DrawingFormat::from_extension("docx"), None);
    /// ```
    pub fn from_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "svg" | "svgz" => Some(Self::Svg),
            "excalidraw" => Some(Self::Excalidraw),
            "tldr" => Some(Self::Tldraw),
            "inkml" | "ink" => Some(Self::InkMl),
            "ndjson" | "jsonl" => Some(Self::Ndjson),
            "json" => Some(Self::Json),
            _ => None,
        }
    }

    /// The format that the first bytes of a file look like.
    ///
    /// ```
    /// use formats::DrawingFormat;
    /// assert_eq!(DrawingFormat::sniff(b"<?xml version='1.0'?><svg/>"), Some(DrawingFormat::Svg));
    /// assert_eq!(DrawingFormat::sniff(br#"{"word":"leaf","drawing":[]}"#), Some(DrawingFormat::Ndjson));
    /// ```
    pub fn sniff(start: &[u8]) -> Option<Self> {
        let head = &start[..start.len().min(4096)];
        let has = |word: &str| head.windows(word.len()).any(|w| w == word.as_bytes());
        let first = head.iter().find(|b| !b.is_ascii_whitespace() && !matches!(b, 0xef | 0xbb | 0xbf))?;
        match first {
            b'<' if has("<svg") || has(":svg") => Some(Self::Svg),
            b'<' if has("<ink") || has(":ink") => Some(Self::InkMl),
            // A packed file: of all drawings only SVG is.
            0x1f if head.starts_with(&[0x1f, 0x8b]) => Some(Self::Svg),
            b'{' if has("\"excalidraw\"") || has("\"excalidraw/clipboard\"") => Some(Self::Excalidraw),
            b'{' if has("\"tldrawFileFormatVersion\"") => Some(Self::Tldraw),
            b'{' if has("\"burgeon\"") => Some(Self::Json),
            b'{' if has("\"drawing\"") || has("\"key_id\"") => Some(Self::Ndjson),
            b'{' if has("\"strokes\"") => Some(Self::Json),
            _ => None,
        }
    }
}

/// The file formats that hold models.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ModelFormat {
    /// Binary glTF 2.0: one file with textures and materials.
    Glb,
    /// glTF 2.0 as JSON with embedded buffers; read only.
    Gltf,
    /// Wavefront OBJ with its material file and textures beside it.
    Obj,
    /// Polygon file format: one mesh with colours at its vertices.
    Ply,
    /// Stereolithography: bare triangles.
    Stl,
    /// Universal Scene Description as text, with textures beside it; written only.
    Usda,
    /// Universal Scene Description as text, with its textures in one file; written only.
    Usdz,
}

impl ModelFormat {
    /// Every format.
    pub const ALL: [Self; 7] =
        [Self::Glb, Self::Gltf, Self::Obj, Self::Ply, Self::Stl, Self::Usda, Self::Usdz];

    /// The name for messages.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Glb => "GLB",
            Self::Gltf => "glTF",
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::Stl => "STL",
            Self::Usda | Self::Usdz => "USD",
        }
    }

    /// How the names of its files end, without the dot.
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Glb => "glb",
            Self::Gltf => "gltf",
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::Stl => "stl",
            Self::Usda => "usda",
            Self::Usdz => "usdz",
        }
    }

    /// The format that a file's extension (without the dot, any case) stands for.
    ///
    /// ```
    /// use formats::ModelFormat;
    /// assert_eq!(ModelFormat::from_extension("GLB"), Some(ModelFormat::Glb));
    /// ```
    pub fn from_extension(extension: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.extension().eq_ignore_ascii_case(extension))
    }

    /// The format that the first bytes of a file look like. A binary STL has no mark and is not recognised.
    pub fn sniff(start: &[u8]) -> Option<Self> {
        let text = start.trim_ascii_start();
        // Exporters of OBJ sign in comments.
        let mut lines = start.split(|&b| b == b'\n').map(<[u8]>::trim_ascii_start);
        let first = lines.find(|l| !l.is_empty() && !l.starts_with(b"#")).unwrap_or_default();
        if start.starts_with(b"glTF") {
            Some(Self::Glb)
        } else if start.starts_with(b"#usda ") {
            Some(Self::Usda)
        } else if start.starts_with(b"ply\n") || start.starts_with(b"ply\r") {
            Some(Self::Ply)
        } else if text.starts_with(b"solid ") {
            Some(Self::Stl)
        } else if text.starts_with(b"{") && start.windows(7).any(|w| w == b"\"asset\"") {
            Some(Self::Gltf)
        } else if [&b"v "[..], b"vn ", b"mtllib ", b"o ", b"g "].iter().any(|w| first.starts_with(w)) {
            Some(Self::Obj)
        } else {
            None
        }
    }

    /// The axes and the unit are the format's own: metres, +Y up.
    pub const fn fixed_axes(self) -> bool {
        matches!(self, Self::Glb | Self::Gltf)
    }

    /// Files of this format have room for how wind moves each vertex.
    pub const fn carries_wind(self) -> bool {
        matches!(self, Self::Glb | Self::Gltf | Self::Usda | Self::Usdz)
    }
}

/// The file formats that hold the structure of a plant, as text; written only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum StructureFormat {
    /// The structure of each plant as a multiscale tree graph.
    Mtg,
    /// The structure of each plant with the meshes of its organs, as Open Plant Format.
    Opf,
    /// The structure of each plant as a table of cylinders.
    Qsm,
    /// The skeleton of each plant as a table of points.
    Swc,
}

/// What is known of a format of structure.
struct StructureRow {
    word: &'static str,
    extension: &'static str,
    /// Files are told to be of it by their extension.
    is_named: bool,
    about: &'static str,
}

impl StructureFormat {
    /// Every format.
    pub const ALL: [Self; 4] = [Self::Mtg, Self::Opf, Self::Qsm, Self::Swc];

    const fn row(self) -> StructureRow {
        let (word, extension, is_named, about) = match self {
            Self::Mtg => ("mtg", "mtg", true, "Multiscale tree graph: axes, nodes and organs as text"),
            Self::Opf => {
                ("opf", "opf", true, "Open Plant Format: axes, internodes and organs with their meshes")
            }
            // A table may be anything.
            Self::Qsm => ("qsm", "csv", false, "Quantitative structure model: a table of cylinders"),
            Self::Swc => {
                ("swc", "swc", true, "Skeleton: points with radii, each with the one that it grows from")
            }
        };
        StructureRow { word, extension, is_named, about }
    }

    /// The word by which it is asked for.
    pub const fn word(self) -> &'static str {
        self.row().word
    }

    /// How the names of its files end, without the dot.
    pub const fn extension(self) -> &'static str {
        self.row().extension
    }

    /// What it is, in a line.
    pub const fn about(self) -> &'static str {
        self.row().about
    }

    /// Organs are written with their meshes.
    pub const fn has_meshes(self) -> bool {
        matches!(self, Self::Opf)
    }

    /// The format of a word, such as `mtg`.
    ///
    /// ```
    /// use formats::StructureFormat;
    /// assert_eq!(StructureFormat::from_word("qsm"), Some(StructureFormat::Qsm));
    /// assert_eq!(StructureFormat::from_word("csv"), None);
    /// ```
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.word() == word)
    }

    /// The format that a file's extension (without the dot, any case) stands for; none for that of tables, which may hold
    /// anything.
    ///
    /// ```
    /// use formats::StructureFormat;
    /// assert_eq!(StructureFormat::from_extension("MTG"), Some(StructureFormat::Mtg));
    /// assert_eq!(StructureFormat::from_extension("csv"), None);
    /// ```
    pub fn from_extension(extension: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.row().is_named && f.row().extension.eq_ignore_ascii_case(extension))
    }
}
