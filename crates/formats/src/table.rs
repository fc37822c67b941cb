//! The table of formats: the source of every list of formats, help text, message and page of the docs.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Content for which a format has room.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Room {
    /// Any unit and up axis; other formats fix theirs.
    Axes,
    /// Several meshes; other formats of models hold a single one.
    Parts,
    /// Textures.
    Textures,
    /// Heights of bark, as a texture.
    Heights,
    /// Light that leaves transmit, as a texture.
    Translucence,
    /// How wind moves each vertex.
    Wind,
    /// All levels of detail in one file.
    Levels,
    /// Meshes that are stored once and have many places.
    Instances,
    /// Joints with an animation.
    Joints,
    /// Shapes of an animation.
    Morphs,
    /// Numbers in few bits, compressed.
    Packing,
    /// The meshes of a plant's organs, in addition to its structure.
    OrganMeshes,
}

base::words!(Room {
    Axes = "axes",
    Parts = "parts",
    Textures = "textures",
    Heights = "heights",
    Translucence = "translucence",
    Wind = "wind",
    Levels = "levels",
    Instances = "instances",
    Joints = "joints",
    Morphs = "morphs",
    Packing = "packing",
    OrganMeshes = "organ-meshes",
});

/// Kind of a companion file, which another file names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beside {
    /// A file of materials.
    Materials,
    /// The numbers of its meshes.
    Buffer,
    /// The pictures of its materials.
    Textures,
    /// The visible meshes of its bodies.
    Meshes,
    /// Groups of its joints in the wind.
    Wind,
}

impl Beside {
    /// Returns a phrase for messages.
    pub const fn phrase(self) -> &'static str {
        match self {
            Self::Materials => "the materials",
            Self::Buffer => "the buffer",
            Self::Textures => "a texture",
            Self::Meshes => "a mesh",
            Self::Wind => "the wind",
        }
    }

    /// Returns the extension of its file, without the dot, if the rest of the name is the stem of the file that names
    /// it: not so for textures and meshes.
    pub const fn ending(self) -> Option<&'static str> {
        match self {
            Self::Materials => Some("mtl"),
            Self::Buffer => Some("bin"),
            Self::Textures | Self::Meshes | Self::Wind => None,
        }
    }
}

/// Access of Burgeon to a format: reading, writing, or both.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Read only.
    Read,
    /// Written only.
    Write,
    /// Read and written.
    Both,
}

/// A row of the table of formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FormatRow {
    /// Word for the format on the command line and in specs, each once in the whole table.
    pub word: &'static str,
    /// Name for messages.
    pub name: &'static str,
    /// Extensions of its files, without the dot; written files have the first.
    pub endings: &'static [&'static str],
    /// Media type of its files.
    pub media_type: &'static str,
    /// Description in one line without a full stop.
    pub about: &'static str,
    /// Whether Burgeon reads it, writes it or both.
    pub access: Access,
    /// Contents for which its files have room.
    pub holds: &'static [Room],
    /// Companion files.
    pub beside: &'static [Beside],
}

impl FormatRow {
    /// Returns whether Burgeon reads the format.
    pub const fn is_read(&self) -> bool {
        !matches!(self.access, Access::Write)
    }

    /// Returns whether Burgeon writes the format.
    pub const fn is_written(&self) -> bool {
        !matches!(self.access, Access::Read)
    }
}

/// Defines the formats of one kind of content, a row each.
macro_rules! formats {
    ($(#[$meta:meta])* $name:ident { $($variant:ident = $word:literal {
        name: $label:literal,
        endings: $endings:expr,
        media_type: $media_type:literal,
        about: $about:literal,
        access: $access:ident,
        holds: [$($room:ident),*],
        beside: [$($beside:ident),*],
    })+ }) => {
        $(#[$meta])*
        #[derive(
            Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
        )]
        pub enum $name { $(
            #[doc = concat!($about, ".")]
            #[serde(rename = $word)]
            $variant,
        )+ }

        base::words!($name { $($variant = $word),+ });

        impl $name {
            /// Returns the format's row of the table.
            pub const fn row(self) -> &'static FormatRow {
                match self { $(Self::$variant => &FormatRow {
                    word: $word,
                    name: $label,
                    endings: $endings,
                    media_type: $media_type,
                    about: $about,
                    access: Access::$access,
                    holds: &[$(Room::$room),*],
                    beside: &[$(Beside::$beside),*],
                },)+ }
            }

            /// Returns the name for messages.
            pub const fn name(self) -> &'static str {
                self.row().name
            }

            /// Returns the extension of written files, without the dot.
            pub const fn extension(self) -> &'static str {
                self.row().endings[0]
            }

            /// Returns whether its files have room for this content.
            pub fn holds(self, room: Room) -> bool {
                self.row().holds.contains(&room)
            }

            /// Returns the format that has this file extension (without the dot, any case).
            pub fn from_extension(extension: &str) -> Option<Self> {
                let is_own = |f: &Self| f.row().endings.iter().any(|e| e.eq_ignore_ascii_case(extension));
                Self::ALL.into_iter().find(is_own)
            }

            /// Returns the extensions of all formats that Burgeon reads, as a list for people: `.a, .b or .c`.
            pub fn read_endings() -> String {
                let read = Self::ALL.into_iter().map(Self::row).filter(|row| row.is_read());
                list_of_endings(read.flat_map(|row| row.endings))
            }

            /// Returns the extensions of all formats that Burgeon writes, as a list for people: `.a, .b or .c`.
            pub fn written_endings() -> String {
                let written = Self::ALL.into_iter().map(Self::row).filter(|row| row.is_written());
                list_of_endings(written.map(|row| &row.endings[0]))
            }

            /// Returns the extensions of all written formats with room for this content, as a list for people.
            pub fn endings_with(room: Room) -> String {
                let written = Self::ALL.into_iter().filter(|f| f.row().is_written() && f.holds(room));
                list_of_endings(written.map(|f| &f.row().endings[0]))
            }
        }
    };
}

formats! {
    /// The file formats that hold models.
    ModelFormat {
        Glb = "glb" {
            name: "GLB",
            endings: &["glb"],
            media_type: "model/gltf-binary",
            about: "Binary glTF: one file with textures and materials",
            access: Both,
            holds: [Parts, Textures, Translucence, Wind, Levels, Instances, Joints, Morphs, Packing],
            beside: [],
        }
        Gltf = "gltf" {
            name: "glTF",
            endings: &["gltf"],
            media_type: "model/gltf+json",
            about: "glTF as text, with its buffer and textures beside it",
            access: Both,
            holds: [Parts, Textures, Translucence, Wind, Levels, Instances, Joints, Morphs, Packing],
            beside: [Buffer, Textures],
        }
        Obj = "obj" {
            name: "OBJ",
            endings: &["obj"],
            media_type: "model/obj",
            about: "Wavefront OBJ with its material file and textures beside it",
            access: Both,
            holds: [Axes, Parts, Textures, Heights],
            beside: [Materials, Textures],
        }
        Ply = "ply" {
            name: "PLY",
            endings: &["ply"],
            media_type: "application/octet-stream",
            about: "PLY: one mesh with colours",
            access: Both,
            holds: [Axes],
            beside: [],
        }
        Stl = "stl" {
            name: "STL",
            endings: &["stl"],
            media_type: "model/stl",
            about: "Stereolithography: bare triangles",
            access: Both,
            holds: [Axes],
            beside: [],
        }
        Usda = "usda" {
            name: "USD",
            endings: &["usda"],
            media_type: "model/vnd.usda",
            about: "Universal Scene Description as text, with textures beside it",
            access: Write,
            holds: [Axes, Parts, Textures, Wind],
            beside: [Textures],
        }
        Usdz = "usdz" {
            name: "USD",
            endings: &["usdz"],
            media_type: "model/vnd.usdz+zip",
            about: "Universal Scene Description with its textures in one file",
            access: Write,
            holds: [Axes, Parts, Textures, Wind],
            beside: [],
        }
    }
}

formats! {
    /// The file formats that hold the structure of a plant, as text.
    StructureFormat {
        Mtg = "mtg" {
            name: "MTG",
            endings: &["mtg"],
            media_type: "text/plain",
            about: "Multiscale tree graph: axes, nodes and organs as text",
            access: Both,
            holds: [Axes],
            beside: [],
        }
        Opf = "opf" {
            name: "OPF",
            endings: &["opf"],
            media_type: "application/xml",
            about: "Open Plant Format: axes, internodes and organs with their meshes",
            access: Both,
            holds: [Axes, OrganMeshes],
            beside: [],
        }
        Qsm = "qsm" {
            name: "QSM",
            endings: &["qsm.csv"],
            media_type: "text/csv",
            about: "Quantitative structure model: a table of cylinders",
            access: Both,
            holds: [Axes],
            beside: [],
        }
        Swc = "swc" {
            name: "SWC",
            endings: &["swc"],
            media_type: "text/plain",
            about: "Skeleton: points with radii, each with the one that it grows from",
            access: Both,
            holds: [Axes],
            beside: [],
        }
    }
}

formats! {
    /// The file formats that hold a plant as bodies and joints, for simulators of robots; written only.
    RobotFormat {
        Mjcf = "mjcf" {
            name: "MJCF",
            endings: &["xml"],
            media_type: "application/xml",
            about: "MuJoCo: bodies, springy joints, collision shapes, with meshes beside it",
            access: Write,
            holds: [],
            beside: [Meshes],
        }
        Urdf = "urdf" {
            name: "URDF",
            endings: &["urdf"],
            media_type: "application/xml",
            about: "Unified Robot Description Format: links and joints, with meshes beside it",
            access: Write,
            holds: [],
            beside: [Meshes],
        }
        Usd = "usd-physics" {
            name: "USD physics",
            endings: &["physics.usda"],
            media_type: "model/vnd.usda",
            about: "Universal Scene Description with rigid bodies and springy joints (UsdPhysics)",
            access: Write,
            holds: [],
            beside: [],
        }
    }
}

formats! {
    /// The file formats that hold strokes.
    DrawingFormat {
        Svg = "svg" {
            name: "SVG",
            endings: &["svg", "svgz"],
            media_type: "image/svg+xml",
            about: "Scalable Vector Graphics; one drawing a file",
            access: Both,
            holds: [],
            beside: [],
        }
        InkMl = "inkml" {
            name: "InkML",
            endings: &["inkml", "ink"],
            media_type: "application/inkml+xml",
            about: "Ink Markup Language (W3C 2011); one drawing a file",
            access: Read,
            holds: [],
            beside: [],
        }
        Ndjson = "ndjson" {
            name: "ndjson",
            endings: &["ndjson", "jsonl"],
            media_type: "application/x-ndjson",
            about: "One JSON object a line, as in \"Quick, Draw!\"; any number of drawings a file",
            access: Read,
            holds: [],
            beside: [],
        }
        Json = "json" {
            name: "drawing JSON",
            endings: &["json"],
            media_type: "application/json",
            about: "Our own `drawing/1`; one drawing a file",
            access: Both,
            holds: [],
            beside: [],
        }
        Excalidraw = "excalidraw" {
            name: "Excalidraw",
            endings: &["excalidraw"],
            media_type: "application/vnd.excalidraw+json",
            about: "Excalidraw's files and what it puts on the clipboard; one drawing a file",
            access: Read,
            holds: [],
            beside: [],
        }
        Tldraw = "tldraw" {
            name: "tldraw",
            endings: &["tldr"],
            media_type: "application/vnd.tldraw+json",
            about: "tldraw's files; one drawing a file",
            access: Read,
            holds: [],
            beside: [],
        }
    }
}

formats! {
    /// The file formats that hold scans.
    CloudFormat {
        Ply = "ply" {
            name: "PLY",
            endings: &["ply"],
            media_type: "application/octet-stream",
            about: "Polygon file format, text or binary; faces are left out",
            access: Both,
            holds: [Axes],
            beside: [],
        }
        Xyz = "xyz" {
            name: "XYZ",
            endings: &["xyz", "txt", "csv", "asc", "pts", "xyzn", "xyzrgb"],
            media_type: "text/plain",
            about: "One point a line: x y z and more columns, separated by spaces, commas or semicolons",
            access: Read,
            holds: [Axes],
            beside: [],
        }
        Pcd = "pcd" {
            name: "PCD",
            endings: &["pcd"],
            media_type: "application/octet-stream",
            about: "Point cloud data of PCL, text, binary or compressed",
            access: Read,
            holds: [Axes],
            beside: [],
        }
        Las = "las" {
            name: "LAS",
            endings: &["las", "laz"],
            media_type: "application/vnd.las",
            about: "LAS 1.0 to 1.4; compressed (LAZ, COPC) in the command and Python",
            access: Read,
            holds: [Axes],
            beside: [],
        }
        Obj = "obj" {
            name: "OBJ",
            endings: &["obj"],
            media_type: "model/obj",
            about: "Vertices of a Wavefront OBJ; faces are left out",
            access: Read,
            holds: [Axes],
            beside: [],
        }
        E57 = "e57" {
            name: "E57",
            endings: &["e57"],
            media_type: "model/e57",
            about: "ASTM E57, all scans of a file; in the command and Python",
            access: Read,
            holds: [Axes],
            beside: [],
        }
    }
}

/// Formats extensions as a list for people, such as `.glb, .obj or .ply`.
pub fn list_of_endings<'a>(endings: impl IntoIterator<Item = &'a &'static str>) -> String {
    let all: Vec<String> = endings.into_iter().map(|e| format!(".{e}")).collect();
    base::either(&all.iter().map(String::as_str).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows() -> Vec<&'static FormatRow> {
        let models = ModelFormat::ALL.into_iter().map(ModelFormat::row);
        let structures = StructureFormat::ALL.into_iter().map(StructureFormat::row);
        let robots = RobotFormat::ALL.into_iter().map(RobotFormat::row);
        models
            .chain(structures)
            .chain(robots)
            .chain(DrawingFormat::ALL.into_iter().map(DrawingFormat::row))
            .collect()
    }

    #[test]
    fn words_and_endings_of_what_is_written_are_there_once() {
        for column in [|row: &FormatRow| row.word, |row: &FormatRow| row.endings[0]] {
            let mut all: Vec<&str> = rows().into_iter().map(column).collect();
            let count = all.len();
            all.sort_unstable();
            all.dedup();
            assert_eq!(all.len(), count);
        }
    }

    #[test]
    fn a_format_is_found_by_its_word_and_by_its_endings() {
        for format in ModelFormat::ALL {
            assert_eq!(ModelFormat::from_word(format.word()), Some(format));
            for ending in format.row().endings {
                assert_eq!(ModelFormat::from_extension(&ending.to_uppercase()), Some(format));
            }
            let written = serde_json::to_string(&format).unwrap();
            assert_eq!(written, format!("{:?}", format.word()));
        }
        assert_eq!(StructureFormat::from_extension("csv"), None, "a table may be anything");
        assert_eq!(DrawingFormat::from_extension("docx"), None);
    }
}
