//! Textures of pivots, read as Unreal's material functions read them.
#![expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small numbers")]

use base::{Run, Seed};
use formats::read_picture;
use glam::DVec3;
use plant::AxisId;
use skin::{Owner, SkinSpec};

use super::*;
use crate::trees::{Preset, TreeOptions, make_tree};

/// The two textures, and what the material functions make of them; in metres and glTF's coordinates again.
struct Shader {
    columns: usize,
    rows: usize,
    pivots: Vec<[f32; 4]>,
    axes: Vec<[u8; 4]>,
}

impl Shader {
    fn new(files: &[BesideFile]) -> Self {
        let (columns, rows, pivots) = read_exr(&files[0].bytes);
        let axes = read_picture(&files[1].bytes).expect("a picture");
        assert_eq!((axes.width as usize, axes.height as usize), (columns, rows));
        let axes = axes.pixels.chunks_exact(4).map(|p| [p[0], p[1], p[2], p[3]]).collect();
        Self { columns, rows, pivots, axes }
    }

    /// `ms_PivotPainter2_CalculateMeshElementIndex`.
    fn index(&self, uv: [f32; 2]) -> usize {
        let at = |x: f32, count: usize| (f64::from(x) * count as f64).floor() as usize;
        at(uv[0], self.columns) + at(uv[1], self.rows) * self.columns
    }

    /// `ms_PivotPainter2_DecodePosition`.
    fn pivot(&self, index: usize) -> DVec3 {
        let [x, y, z, _] = self.pivots[index].map(f64::from);
        DVec3::new(x, z, y) / 100.0
    }

    /// `ms_PivotPainter2_UnpackIntegerAsFloat` of the alpha channel: the bits of the 16-bit float less 1024.
    fn parent(&self, index: usize) -> usize {
        let bits = self.pivots[index][3].to_bits();
        let exponent = (bits >> 23 & 0xff) as i32 - 127 + 15;
        ((bits >> 16 & 0x8000) | (exponent as u32) << 10 | (bits >> 13 & 0x3ff)) as usize - 1024
    }

    /// `ms_PivotPainter2_DecodeAxisVector`.
    fn way(&self, index: usize) -> DVec3 {
        let [x, y, z] = [0, 1, 2].map(|k| 2.0 * (f64::from(self.axes[index][k]) / 255.0 - 0.5));
        DVec3::new(x, z, y).normalize()
    }

    /// `ms_PivotPainter2_Decode8BitAlphaAxisExtent`.
    fn extent(&self, index: usize) -> f64 {
        (f64::from(self.axes[index][3]) / 255.0 * 2048.0).max(8.0) / 100.0
    }
}

/// Reads an EXR of four half channels without compression: columns, rows, RGBA.
fn read_exr(bytes: &[u8]) -> (usize, usize, Vec<[f32; 4]>) {
    let word = |at: usize| i32::from_le_bytes(bytes[at..at + 4].try_into().expect("4 bytes"));
    let text = |at: usize| {
        let length = bytes[at..].iter().position(|b| *b == 0).expect("an end");
        (std::str::from_utf8(&bytes[at..at + length]).expect("a name"), at + length + 1)
    };
    assert_eq!((word(0), word(4)), (20_000_630, 2));
    let (mut at, mut window, mut channels) = (8, [0; 4], Vec::new());
    while bytes[at] != 0 {
        let (name, next) = text(at);
        let (_, next) = text(next);
        let value = next + 4;
        match name {
            "dataWindow" => window = [0, 4, 8, 12].map(|k| word(value + k)),
            "compression" => assert_eq!(bytes[value], 0),
            "channels" => {
                let mut row = value;
                while bytes[row] != 0 {
                    let (channel, next) = text(row);
                    assert_eq!([0, 8, 12].map(|k| word(next + k)), [1, 1, 1], "half, in each pixel");
                    channels.push("RGBA".find(channel).expect("a channel"));
                    row = next + 16;
                }
            }
            _ => {}
        }
        at = value + word(next) as usize;
    }
    let [columns, rows] = [2, 3].map(|k| window[k] as usize + 1);
    let mut pixels = vec![[0.0; 4]; columns * rows];
    for row in 0..rows {
        let offset = at + 1 + 8 * row;
        let line = u64::from_le_bytes(bytes[offset..offset + 8].try_into().expect("8 bytes")) as usize;
        assert_eq!((word(line), word(line + 4)), (row as i32, 8 * columns as i32));
        for (k, channel) in channels.iter().enumerate() {
            for column in 0..columns {
                let at = line + 8 + 2 * (k * columns + column);
                pixels[row * columns + column][*channel] = float_of([bytes[at], bytes[at + 1]]);
            }
        }
    }
    assert_eq!(bytes.len(), at + 1 + rows * (8 + 8 + 8 * columns), "nothing else");
    (columns, rows, pixels)
}

fn float_of(bytes: [u8; 2]) -> f32 {
    let half = u32::from(u16::from_le_bytes(bytes));
    let (sign, exponent, fraction) = (half >> 15 << 31, half >> 10 & 0x1f, half & 0x3ff);
    match exponent {
        0 => (fraction as f32 / 16_777_216.0) * if sign > 0 { -1.0 } else { 1.0 },
        _ => f32::from_bits(sign | (exponent + 112) << 23 | fraction << 13),
    }
}

#[test]
fn material_functions_find_the_pivots_and_parents_of_a_tree() {
    let spec = Preset::find("hazel").expect("a preset").spec().expect("sound");
    let spec = crate::TreeSpec { age: Some(4), ..spec };
    let skin = SkinSpec { wind: true, texture_size: 64, ..SkinSpec::default() };
    let options = TreeOptions { skin, ..TreeOptions::default() };
    let made = make_tree(&spec, Seed::new(1), &options, &Run::plain()).expect("a tree");
    let (plant, model) = (&made.grown.plant, &made.model);
    let painter = PivotPainter::new(plant).expect("elements");
    let shader = Shader::new(&painter.textures(model, "hazel").expect("writes"));
    let tubes = skin::tubes_of(plant);
    let tube_of = |axis: AxisId| tubes.iter().position(|tube| tube.contains(&axis)).expect("a tube");
    let foot = |tube: usize| plant.axis_points(tubes[tube][0])[0];
    let bearer = |tube: usize| {
        let node = plant.axis(tubes[tube][0]).bearer?;
        Some(tube_of(plant.nodes.axis[node.index()]))
    };
    let steps = |tube: usize| std::iter::successors(bearer(tube), |t| bearer(*t)).count();
    // The wood that moves as one with this: two steps from the trunk there is no finer.
    let held = |tube: usize| {
        std::iter::successors(Some(tube), |t| bearer(*t)).find(|t| steps(*t) <= 2).expect("a trunk")
    };
    let near = |a: DVec3, b: DVec3| a.distance(b) <= 1e-3 * b.length() + 1e-4;
    let (mut wood, mut leaves, mut strays) = (0, 0, 0);
    for ((part, cells), owners) in model.parts.iter().zip(painter.cells(model)).zip(made.layout.owners()) {
        let mut corners = part.mesh.triangles.iter();
        for (owner, count) in owners.filter(|(_, count)| *count > 0) {
            let vertex = corners.nth(count as usize - 1).expect("triangles")[0] as usize;
            let index = shader.index(cells[vertex]);
            let (pivot, parent) = (shader.pivot(index), shader.parent(index));
            match owner {
                Owner::Axes(axes)
                    if !matches!(plant.axis(axes[0]).kind, AxisKind::Petiole | AxisKind::Root) =>
                {
                    wood += 1;
                    let tube = held(tube_of(axes[0]));
                    let base = bearer(tube).map_or(foot(tube), foot);
                    strays += usize::from(!near(pivot, foot(tube)) || !near(shader.pivot(parent), base));
                    assert!(bearer(tube).is_some() || parent == index, "what stands bears itself");
                }
                Owner::Axes(_) => {}
                Owner::Organ(id) => {
                    leaves += 1;
                    let organ = &plant.organs[id.index()];
                    let axis = plant.nodes.axis[organ.bearer.expect("a bearer").index()];
                    let (root, tube) = match plant.axis(axis).kind {
                        AxisKind::Petiole => (foot(tube_of(axis)), bearer(tube_of(axis)).expect("a twig")),
                        _ => (organ.frame.origin, tube_of(axis)),
                    };
                    assert!(near(pivot, root), "{pivot} and {root}");
                    strays += usize::from(!near(shader.pivot(parent), foot(held(tube))));
                }
            }
            let place = DVec3::from(part.mesh.positions[vertex].map(f64::from)) - pivot;
            assert!(place.dot(shader.way(index)) <= shader.extent(index) + 0.08, "within its extent");
        }
    }
    assert!(
        wood > 20 && leaves > 100 && 100 * strays <= wood,
        "{wood} tubes, {strays} strays, {leaves} leaves"
    );
}

#[test]
fn a_coarser_level_reads_the_same_texels() {
    let spec = Preset::find("hazel").expect("a preset").spec().expect("sound");
    let spec = crate::TreeSpec { age: Some(4), ..spec };
    let skin = SkinSpec { wind: true, texture_size: 64, ..SkinSpec::default() };
    let levels = crate::LevelSpec { lods: 1, ..crate::LevelSpec::default() };
    let options = TreeOptions { skin, levels, ..TreeOptions::default() };
    let made = make_tree(&spec, Seed::new(1), &options, &Run::plain()).expect("a tree");
    let painter = PivotPainter::new(&made.grown.plant).expect("elements");
    let shader = Shader::new(&painter.textures(&made.model, "hazel").expect("writes"));
    let coarse = &made.levels.lods[0];
    let mut found = 0;
    for (part, cells) in coarse.parts.iter().zip(painter.cells(coarse)) {
        let is_leaf = coarse.material(part).kind == MaterialKind::Leaf;
        for (cell, pivot) in cells.iter().zip(&part.mesh.pivots).filter(|_| is_leaf) {
            let wanted = DVec3::from(pivot.map(f64::from));
            found += usize::from(shader.pivot(shader.index(*cell)).distance(wanted) < 0.2);
        }
    }
    assert!(found > 100, "{found}");
}

#[test]
fn more_leaves_than_the_shader_has_room_for_move_with_their_wood() {
    let mut plant = Plant::default();
    let stem = plant.add_axis(AxisKind::Stem, None, 1, &[DVec3::ZERO, DVec3::Y], None);
    let node = plant.axis(stem).node_ids().next_back();
    plant.nodes.radius_m = vec![0.01; 2];
    assert_eq!(PivotPainter::new(&plant).expect("a stem").elements.len(), 1);
    let spec = Preset::find("hazel").expect("a preset").spec().expect("sound");
    let spec = crate::TreeSpec { age: Some(2), ..spec };
    let leaf = make_tree(&spec, Seed::new(1), &TreeOptions::default(), &Run::plain()).expect("a tree");
    let leaf = leaf.grown.plant.organs.first().expect("a leaf").clone();
    for k in 0..MOST {
        let mut organ = plant::Organ { bearer: node, ..leaf.clone() };
        organ.frame.origin = DVec3::new(0.01, 1e-3 * k as f64, 0.0);
        plant.organs.push(organ);
    }
    assert_eq!(PivotPainter::new(&plant).expect("a stem").elements.len(), 1);
    plant.organs.pop();
    let painter = PivotPainter::new(&plant).expect("a stem");
    assert_eq!((painter.elements.len(), painter.sides()), (MOST, (256, 128)));
    assert!(PivotPainter::new(&Plant::default()).is_none());
}

#[test]
fn an_index_is_a_normal_number_of_16_bits() {
    for index in [0_u32, 1, 1023, 1024, 2047, 2049, 29_999] {
        let bits = index_bits(index);
        let number = float_of(bits.to_le_bytes());
        assert!(number.is_normal() && half_bits(number) == bits, "{index}: {number}");
    }
}
