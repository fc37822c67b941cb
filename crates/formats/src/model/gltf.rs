//! The part of glTF 2.0 that Burgeon reads and writes, as plain data.
//!
//! Own structs, not a crate: the same ones read and write, this crate checks every index (the files may be hostile),
//! and extensions stay open.

use serde::{Deserialize, Serialize};
use serde_json::Value;

pub(super) const FLOAT: u32 = 5126;
pub(super) const U8: u32 = 5121;
pub(super) const U16: u32 = 5123;
pub(super) const U32: u32 = 5125;
pub(super) const I8: u32 = 5120;
pub(super) const I16: u32 = 5122;

pub(super) const POINTS: u32 = 0;
pub(super) const TRIANGLES: u32 = 4;
pub(super) const STRIP: u32 = 5;
pub(super) const FAN: u32 = 6;

fn is_false(b: &bool) -> bool {
    !*b
}

fn is_zero(n: &u64) -> bool {
    *n == 0
}

macro_rules! schema {
    ($($(#[$meta:meta])* struct $name:ident { $($(#[$field:meta])* $key:ident: $type:ty,)* })*) => { $(
        $(#[$meta])*
        #[derive(Clone, Debug, Default, Serialize, Deserialize)]
        #[serde(rename_all = "camelCase")]
        pub(super) struct $name { $($(#[$field])* pub(super) $key: $type,)* }
    )* };
}

schema! {
    struct Root {
        asset: Asset,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        extensions_used: Vec<String>,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        extensions_required: Vec<String>,
        #[serde(skip_serializing_if = "Option::is_none")]
        scene: Option<u32>,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        scenes: Vec<Scene>,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        nodes: Vec<Node>,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        meshes: Vec<Mesh>,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        materials: Vec<Material>,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        textures: Vec<Texture>,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        samplers: Vec<Sampler>,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        images: Vec<Image>,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        accessors: Vec<Accessor>,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        buffer_views: Vec<View>,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        buffers: Vec<Buffer>,
        #[serde(skip_deserializing, skip_serializing_if = "Vec::is_empty")]
        skins: Vec<Skin>,
        // Written, never read: an unknown animation must not make a model unreadable.
        #[serde(skip_deserializing, skip_serializing_if = "Vec::is_empty")]
        animations: Vec<Animation>,
    }
    struct Animation {
        name: String,
        channels: Vec<Channel>,
        samplers: Vec<Keys>,
    }
    struct Skin {
        inverse_bind_matrices: u32,
        joints: Vec<u32>,
        skeleton: u32,
    }
    struct Channel {
        sampler: u32,
        target: Target,
    }
    struct Target {
        node: u32,
        path: String,
    }
    struct Keys {
        input: u32,
        interpolation: String,
        output: u32,
    }
    struct Asset {
        version: String,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        generator: Option<String>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        extras: Option<Value>,
    }
    struct Scene {
        #[serde(default, skip_serializing_if = "Option::is_none")]
        name: Option<String>,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        nodes: Vec<u32>,
    }
    struct Node {
        #[serde(default, skip_serializing_if = "Option::is_none")]
        name: Option<String>,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        children: Vec<u32>,
        #[serde(skip_serializing_if = "Option::is_none")]
        mesh: Option<u32>,
        #[serde(skip_serializing_if = "Option::is_none")]
        skin: Option<u32>,
        #[serde(skip_serializing_if = "Option::is_none")]
        matrix: Option<[f64; 16]>,
        #[serde(skip_serializing_if = "Option::is_none")]
        translation: Option<[f64; 3]>,
        #[serde(skip_serializing_if = "Option::is_none")]
        rotation: Option<[f64; 4]>,
        #[serde(skip_serializing_if = "Option::is_none")]
        scale: Option<[f64; 3]>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        extensions: Option<Value>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        extras: Option<Value>,
    }
    struct Mesh {
        #[serde(default, skip_serializing_if = "Option::is_none")]
        name: Option<String>,
        primitives: Vec<Primitive>,
        #[serde(skip_deserializing, skip_serializing_if = "Vec::is_empty")]
        weights: Vec<f32>,
    }
    struct Primitive {
        attributes: Attributes,
        #[serde(skip_serializing_if = "Option::is_none")]
        indices: Option<u32>,
        #[serde(skip_serializing_if = "Option::is_none")]
        material: Option<u32>,
        #[serde(skip_serializing_if = "Option::is_none")]
        mode: Option<u32>,
        #[serde(skip_deserializing, skip_serializing_if = "Vec::is_empty")]
        targets: Vec<Attributes>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        extensions: Option<Value>,
    }
    struct Attributes {
        #[serde(rename = "POSITION", skip_serializing_if = "Option::is_none")]
        position: Option<u32>,
        #[serde(rename = "NORMAL", skip_serializing_if = "Option::is_none")]
        normal: Option<u32>,
        #[serde(rename = "TEXCOORD_0", skip_serializing_if = "Option::is_none")]
        uv: Option<u32>,
        #[serde(rename = "TEXCOORD_1", skip_deserializing, skip_serializing_if = "Option::is_none")]
        uv1: Option<u32>,
        #[serde(rename = "TEXCOORD_2", skip_deserializing, skip_serializing_if = "Option::is_none")]
        uv2: Option<u32>,
        #[serde(rename = "TEXCOORD_3", skip_deserializing, skip_serializing_if = "Option::is_none")]
        uv3: Option<u32>,
        #[serde(rename = "TEXCOORD_4", skip_deserializing, skip_serializing_if = "Option::is_none")]
        uv4: Option<u32>,
        #[serde(rename = "TEXCOORD_5", skip_deserializing, skip_serializing_if = "Option::is_none")]
        uv5: Option<u32>,
        #[serde(rename = "COLOR_0", skip_serializing_if = "Option::is_none")]
        color: Option<u32>,
        // Names of an application's own attributes begin with an underscore.
        #[serde(rename = "_WIND", skip_serializing_if = "Option::is_none")]
        wind: Option<u32>,
        #[serde(rename = "_PIVOT", skip_serializing_if = "Option::is_none")]
        pivot: Option<u32>,
        #[serde(rename = "JOINTS_0", skip_deserializing, skip_serializing_if = "Option::is_none")]
        joints: Option<u32>,
        #[serde(rename = "WEIGHTS_0", skip_deserializing, skip_serializing_if = "Option::is_none")]
        weights: Option<u32>,
    }
    struct Material {
        #[serde(default, skip_serializing_if = "Option::is_none")]
        name: Option<String>,
        #[serde(default)]
        pbr_metallic_roughness: Pbr,
        #[serde(skip_serializing_if = "Option::is_none")]
        normal_texture: Option<TextureInfo>,
        #[serde(skip_serializing_if = "Option::is_none")]
        occlusion_texture: Option<TextureInfo>,
        #[serde(skip_serializing_if = "Option::is_none")]
        alpha_mode: Option<String>,
        #[serde(default, skip_serializing_if = "is_false")]
        double_sided: bool,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        extensions: Option<Value>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        extras: Option<Value>,
    }
    struct Pbr {
        #[serde(skip_serializing_if = "Option::is_none")]
        base_color_factor: Option<[f32; 4]>,
        #[serde(skip_serializing_if = "Option::is_none")]
        base_color_texture: Option<TextureInfo>,
        #[serde(skip_serializing_if = "Option::is_none")]
        metallic_factor: Option<f32>,
        #[serde(skip_serializing_if = "Option::is_none")]
        roughness_factor: Option<f32>,
        #[serde(skip_serializing_if = "Option::is_none")]
        metallic_roughness_texture: Option<TextureInfo>,
    }
    struct TextureInfo {
        index: u32,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        extensions: Option<Value>,
    }
    struct Texture {
        #[serde(skip_serializing_if = "Option::is_none")]
        sampler: Option<u32>,
        #[serde(skip_serializing_if = "Option::is_none")]
        source: Option<u32>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        extensions: Option<Value>,
    }
    struct Sampler {
        #[serde(skip_serializing_if = "Option::is_none")]
        mag_filter: Option<u32>,
        #[serde(skip_serializing_if = "Option::is_none")]
        min_filter: Option<u32>,
    }
    struct Image {
        #[serde(default, skip_serializing_if = "Option::is_none")]
        name: Option<String>,
        #[serde(skip_serializing_if = "Option::is_none")]
        uri: Option<String>,
        #[serde(skip_serializing_if = "Option::is_none")]
        buffer_view: Option<u32>,
        #[serde(skip_serializing_if = "Option::is_none")]
        mime_type: Option<String>,
    }
    struct Accessor {
        #[serde(skip_serializing_if = "Option::is_none")]
        buffer_view: Option<u32>,
        #[serde(default, skip_serializing_if = "is_zero")]
        byte_offset: u64,
        component_type: u32,
        #[serde(default, skip_serializing_if = "is_false")]
        normalized: bool,
        count: u64,
        #[serde(rename = "type")]
        shape: String,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        min: Option<Vec<f64>>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        max: Option<Vec<f64>>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        sparse: Option<Value>,
    }
    struct View {
        buffer: u32,
        #[serde(default, skip_serializing_if = "is_zero")]
        byte_offset: u64,
        byte_length: u64,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        byte_stride: Option<u64>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        target: Option<u32>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        extensions: Option<Value>,
    }
    struct Buffer {
        byte_length: u64,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        uri: Option<String>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        extensions: Option<Value>,
    }
}
