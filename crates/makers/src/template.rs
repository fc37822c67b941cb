//! Leaf templates: any leaf as the blade of any plant. Marks or a model -> [`LeafTemplate`] -> the leaves of a plant.

use std::collections::BTreeMap;
use std::sync::Arc;

use base::{Report, Run, Seed};
use glam::{DMat3, DVec2, DVec3};
use leaf::{FullMarks, Leaf, LeafPaint, Rays};
use mesh::{MaterialKind, Model, Texture, TriMesh};
use plant::{Blade, BladeVein, FlatLeaf, Lift, OrganKind, Plant, Relief, Shape};
use skin::{LeafColours, SkinSpec, Worn};

use crate::error::LeafError;
use crate::look::{LeafLook, LeafyPlant};
use crate::measured::{RayLeafParts, build_ray_leaf};

/// A leaf that other makers' plants bear: a blade of length 1 and its picture, if it has one.
#[derive(Clone, Debug, PartialEq)]
pub struct LeafTemplate {
    /// The blade, of length 1.
    blade: Blade,
    /// A picture in the blade's own chart: the midrib in the middle, the tip at the top.
    texture: Option<Arc<Texture>>,
}

/// Reason why a model is not a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TemplateError {
    /// It has no part with triangles.
    #[error("the model has no surface; a leaf needs a sheet of triangles with an open edge")]
    NoSurface,
    /// It has only closed surfaces.
    #[error("the model has no open edge: a closed solid has no outline; use a flat sheet")]
    Closed,
    /// The outline encloses nothing, or crosses itself beyond repair.
    #[error("the outline of the model makes no leaf: flattened, it encloses no area")]
    Degenerate,
}

// Points of a template's outline: enough for lobes, few enough for a crown of leaves.
const OUTLINE_POINTS: usize = 96;

impl LeafTemplate {
    /// Makes a template of a measured leaf: its outline laid flat, its veins, its bend and fold, its picture.
    ///
    /// # Errors
    /// [`LeafError`] for marks that make no leaf.
    pub fn from_marks(
        marks: &FullMarks,
        look: &LeafLook<'_>,
        seed: Seed,
        run: &Run<'_>,
    ) -> Result<Self, LeafError> {
        let marks = look.spec.shaped(marks)?;
        let leaf = Leaf::new(&marks, look.spec)?;
        run.cancel.check()?;
        let mut blade = leaf::leaf_blade(&leaf, &marks, 1.0);
        blade.outline = thinned(blade.outline);
        let flat = leaf.blade().flat(5);
        let painted = || {
            let colours = LeafColours::default().wilted(look.spec.wilt);
            Arc::new(skin::vein_texture(&flat, &colours, 512, seed, run.executor))
        };
        let veins = look.spec.texture == LeafPaint::Veins;
        let picture = look.picture.cloned().or_else(|| veins.then(painted));
        let scale = flat.midrib().last().map_or(1.0, |tip| tip.length()).max(f64::MIN_POSITIVE);
        let texture = picture.map(|p| Arc::new(charted(&p, &blade, |at| flat_uv(&flat, at * scale))));
        Ok(Self { blade, texture })
    }

    /// Makes a template of a leaf of chief veins: its outline laid flat, like that of a model.
    ///
    /// # Errors
    /// [`LeafError`] for veins that make no leaf; [`TemplateError`] inside for a blade without an outline.
    pub fn from_rays(
        rays: &Rays,
        look: &LeafLook<'_>,
        run: &Run<'_>,
    ) -> Result<Result<Self, TemplateError>, LeafError> {
        let built = build_ray_leaf("leaf", rays, (look, 0), run, &mut Report::default())?;
        let RayLeafParts { leafy: LeafyPlant { plant, .. }, rays, .. } = built;
        let spec = SkinSpec { leaf: look.mesh(), textures: false, variation: 0.0, ..SkinSpec::default() };
        let mut model = skin::skin(&plant, &spec, run)?;
        // The root is where the veins start together; it may lie anywhere.
        let root = rays.rays.iter().find_map(|r| r.points.first()).copied().unwrap_or_default();
        for p in model.parts.iter_mut().flat_map(|p| &mut p.mesh.positions) {
            #[expect(clippy::cast_possible_truncation, reason = "positions are f32 in meshes")]
            let moved = (DVec3::from_array(p.map(f64::from)) - root).to_array().map(|x| x as f32);
            *p = moved;
        }
        Ok(Self::from_model(&model))
    }

    /// Makes a template of a model of one leaf: the open edge of its largest surface, laid flat.
    ///
    /// The root is the place of the outline nearest to the model's origin (where modellers put it), the midrib the
    /// straight line to the point farthest from there. Bend and fold are fitted by least squares. The material's
    /// picture is included where texture coordinates lie in its box.
    ///
    /// # Errors
    /// [`TemplateError`].
    pub fn from_model(model: &Model) -> Result<Self, TemplateError> {
        let sheets: Vec<_> = model.parts.iter().filter(|p| !p.mesh.triangles.is_empty()).collect();
        if sheets.is_empty() {
            return Err(TemplateError::NoSurface);
        }
        let open = sheets.iter().filter_map(|p| {
            let sheet = Sheet::new(&p.mesh);
            let rim = sheet.rim();
            let leafy = model.material(p).kind == MaterialKind::Leaf;
            (rim.len() >= 3).then(|| (leafy, sheet.area(), p, sheet, rim))
        });
        // The largest sheet: veins are leafy too, but have less surface than their blade.
        let chosen =
            open.max_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))).ok_or(TemplateError::Closed)?;
        let (_, _, part, sheet, rim) = chosen;
        let flat = sheet.flat(&rim).ok_or(TemplateError::Degenerate)?;
        let mut outline: Vec<DVec2> = rim.iter().map(|&k| flat.points[k as usize]).collect();
        if geom::signed_area(&outline) < 0.0 {
            outline.reverse();
        }
        let root = (0..outline.len()).min_by(|&a, &b| outline[a].length().total_cmp(&outline[b].length()));
        outline.rotate_left(root.unwrap_or(0));
        if geom::self_crossings(&outline) > 0 {
            outline = geom::simple_outline(&outline).ok_or(TemplateError::Degenerate)?;
        }
        if geom::signed_area(&outline) < 1e-4 {
            return Err(TemplateError::Degenerate);
        }
        let blade = Blade {
            outline: thinned(outline),
            midrib: vec![DVec2::ZERO, DVec2::new(0.0, 0.5), DVec2::Y],
            veins: vec![],
            needles: None,
            lift: Lift::Flat,
            relief: flat.relief(),
        };
        let picture = model.material(part).texture.clone();
        let texture = picture
            .filter(|_| part.mesh.uvs.len() == part.mesh.positions.len())
            .map(|p| Arc::new(flat.painted(&part.mesh, &sheet.welded, &p, &blade)));
        Ok(Self { blade, texture })
    }

    /// Makes a template of the largest leaf of a plant, without its picture; `None` if it has no leaf.
    pub fn from_plant(plant: &Plant) -> Option<Self> {
        let leaves = plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf);
        let blades = leaves.filter_map(|o| match plant.shapes.get(o.shape.index())? {
            Shape::Blade(b) => Some((b.length() * o.scale, b)),
            _ => None,
        });
        // The first of the largest, so that the same plant gives the same leaf.
        let largest = blades.fold(None, |best: Option<(f64, &Blade)>, new| match best {
            Some(old) if old.0 >= new.0 => Some(old),
            _ => Some(new),
        });
        let blade = largest.map(|(_, b)| b).filter(|b| b.length() > 0.0)?;
        let mut blade = Self { blade: blade.clone(), texture: None }.scaled(1.0 / blade.length());
        blade.outline = thinned(blade.outline);
        Some(Self { blade, texture: None })
    }

    /// Gives every leaf of a plant this blade, each as long as its own; returns how many leaves.
    ///
    /// Places, directions, sizes and tints of the leaves stay. Cost: linear in shapes and organs.
    pub fn apply(&self, plant: &mut Plant) -> usize {
        let mut other = vec![false; plant.shapes.len()];
        for organ in plant.organs.iter().filter(|o| o.kind != OrganKind::Leaf) {
            if let Some(used) = other.get_mut(organ.shape.index()) {
                *used = true;
            }
        }
        let mut now: base::LiteMap<usize, plant::ShapeId> = base::LiteMap::new();
        let mut count = 0;
        for k in 0..plant.organs.len() {
            let shape = plant.organs[k].shape;
            let Some(Shape::Blade(old)) = plant.shapes.get(shape.index()) else { continue };
            if plant.organs[k].kind != OrganKind::Leaf {
                continue;
            }
            count += 1;
            if let Some(&id) = now.get(&shape.index()) {
                plant.organs[k].shape = id;
                continue;
            }
            let new = Shape::Blade(Blade { lift: old.lift, ..self.scaled(old.length()) });
            let id = if other[shape.index()] {
                plant.shapes.push(new);
                plant::ShapeId::new(plant.shapes.len() - 1)
            } else {
                plant.shapes[shape.index()] = new;
                shape
            };
            now.insert(shape.index(), id);
            plant.organs[k].shape = id;
        }
        count
    }

    /// Whether it has a picture of its own.
    pub fn has_picture(&self) -> bool {
        self.texture.is_some()
    }

    /// Puts the template's picture on the leaves of a skinned plant, if it has one.
    pub fn dress(&self, model: &mut Model, worn: &Worn) {
        let Some(texture) = &self.texture else { return };
        for material in model.materials.iter_mut().filter(|m| m.kind == MaterialKind::Leaf) {
            if material.texture.is_some() && !worn.is_worn(&material.name) {
                material.texture = Some(texture.clone());
            }
        }
    }

    /// Returns the blade at a length in metres.
    pub fn scaled(&self, length_m: f64) -> Blade {
        let scaled = |line: &[DVec2]| line.iter().map(|&p| p * length_m).collect::<Vec<_>>();
        Blade {
            outline: scaled(&self.blade.outline),
            midrib: scaled(&self.blade.midrib),
            veins: self.blade.veins.iter().map(|v| BladeVein { line: scaled(&v.line), ..*v }).collect(),
            ..self.blade.clone()
        }
    }
}

/// Returns at most [`OUTLINE_POINTS`] points; the first, the root, stays.
fn thinned(outline: Vec<DVec2>) -> Vec<DVec2> {
    let step = outline.len().div_ceil(OUTLINE_POINTS).max(1);
    if step == 1 {
        return outline;
    }
    let thin: Vec<DVec2> = outline.iter().copied().step_by(step).collect();
    // Teeth that are closer than the points may cross one another in the result.
    if geom::self_crossings(&thin) > 0 { outline } else { thin }
}

fn flat_uv(flat: &FlatLeaf, p: DVec2) -> DVec2 {
    let (low, size) = flat.extent();
    let at = (p - low) / size;
    DVec2::new(at.x, 1.0 - at.y)
}

/// Redraws a picture in the chart in which leaves of plants are textured.
fn charted(picture: &Texture, blade: &Blade, uv_of: impl Fn(DVec2) -> DVec2) -> Texture {
    let chart = skin::BladeChart::new(blade);
    let (width, height) = chart_size(&chart);
    let mut out = Texture { width, height, pixels: Vec::with_capacity(4 * (width * height) as usize) };
    for y in 0..height {
        for x in 0..width {
            let uv =
                DVec2::new((f64::from(x) + 0.5) / f64::from(width), (f64::from(y) + 0.5) / f64::from(height));
            out.pixels.extend(sample(picture, uv_of(chart.place(uv))));
        }
    }
    out
}

/// Returns 512 pixels from tip to root, and the width in proportion to the leaf's.
fn chart_size(chart: &skin::BladeChart) -> (u32, u32) {
    let aspect = (chart.place(DVec2::new(1.0, 0.5)).x - chart.place(DVec2::new(0.0, 0.5)).x)
        / (chart.place(DVec2::X).y - chart.place(DVec2::ONE).y).max(1e-9);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped before the cast")]
    let width = (512.0 * aspect).round().clamp(32.0, 1024.0) as u32;
    (width, 512)
}

/// Returns the pixel at `uv`, the nearest within the picture.
fn sample(picture: &Texture, uv: DVec2) -> [u8; 4] {
    let at = |x: f64, n: u32| {
        let x = if x.is_finite() { x.clamp(0.0, 1.0) * f64::from(n) } else { 0.0 };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to the size")]
        let k = x as usize;
        k.min((n as usize).saturating_sub(1))
    };
    let k = 4 * (at(uv.y, picture.height) * picture.width as usize + at(uv.x, picture.width));
    picture.pixels.get(k..k + 4).and_then(|p| p.try_into().ok()).unwrap_or([255; 4])
}

/// A surface whose vertices at the same place are one.
struct Sheet {
    points: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// The point of each vertex of the mesh.
    welded: Vec<u32>,
}

impl Sheet {
    fn new(mesh: &TriMesh) -> Self {
        let mut known: BTreeMap<[u32; 3], u32> = BTreeMap::new();
        let mut points = Vec::new();
        let welded: Vec<u32> = (mesh.positions.iter())
            .map(|p| {
                // -0 and 0 are one place.
                let key = p.map(|x| (x + 0.0).to_bits());
                *known.entry(key).or_insert_with(|| {
                    points.push(DVec3::from_array(p.map(f64::from)));
                    u32::try_from(points.len() - 1).unwrap_or(u32::MAX)
                })
            })
            .collect();
        let corner = |k: u32| welded.get(k as usize).copied();
        let triangles = mesh.triangles.iter().filter_map(|&[a, b, c]| {
            let t = [corner(a)?, corner(b)?, corner(c)?];
            (t[0] != t[1] && t[1] != t[2] && t[0] != t[2]).then_some(t)
        });
        Self { triangles: triangles.collect(), points, welded }
    }

    fn area(&self) -> f64 {
        let p = |k: u32| self.points[k as usize];
        self.triangles.iter().map(|&[a, b, c]| 0.5 * (p(b) - p(a)).cross(p(c) - p(a)).length()).sum()
    }

    /// Returns the longest open edge, as points in order.
    fn rim(&self) -> Vec<u32> {
        let mut sides: BTreeMap<(u32, u32), i32> = BTreeMap::new();
        for &[a, b, c] in &self.triangles {
            for (i, j) in [(a, b), (b, c), (c, a)] {
                *sides.entry((i.min(j), i.max(j))).or_insert(0) += 1;
            }
        }
        let mut next: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (&(a, b), _) in sides.iter().filter(|(_, n)| **n == 1) {
            next.entry(a).or_default().push(b);
            next.entry(b).or_default().push(a);
        }
        let mut best: (f64, Vec<u32>) = (0.0, Vec::new());
        let mut seen = vec![false; self.points.len()];
        for &start in next.keys() {
            if seen[start as usize] {
                continue;
            }
            let (mut line, mut length) = (vec![start], 0.0);
            seen[start as usize] = true;
            let mut at = start;
            while let Some(&to) = next.get(&at).and_then(|n| n.iter().find(|&&k| !seen[k as usize])) {
                length += self.points[at as usize].distance(self.points[to as usize]);
                seen[to as usize] = true;
                line.push(to);
                at = to;
            }
            if length > best.0 {
                best = (length, line);
            }
        }
        best.1
    }

    /// Lays the points into the plane that fits them best, root at the origin, tip at (0, 1); `None` without extent.
    fn flat(&self, rim: &[u32]) -> Option<FlatSheet> {
        let used: Vec<DVec3> = self.triangles.iter().flatten().map(|&k| self.points[k as usize]).collect();
        let (_, axes, lambda) = geom::pca3(&used)?;
        let sound = lambda[1] > 1e-12 * lambda[0] && lambda[0] > 0.0;
        if !sound {
            return None;
        }
        let facing: DVec3 = (self.triangles.iter())
            .map(|&[a, b, c]| {
                let p = |k: u32| self.points[k as usize];
                (p(b) - p(a)).cross(p(c) - p(a))
            })
            .sum();
        let normal = if facing.dot(axes[2]) < 0.0 { -axes[2] } else { axes[2] };
        let at = |k: u32| self.points[k as usize];
        let far = |from: DVec3| {
            rim.iter().copied().max_by(|&a, &b| at(a).distance(from).total_cmp(&at(b).distance(from)))
        };
        let near = rim.iter().copied().min_by(|&a, &b| at(a).length().total_cmp(&at(b).length()))?;
        let size = at(near).distance(at(far(at(near))?));
        let root = if at(near).length() < 0.25 * size {
            near
        } else {
            // Far from the origin: the lower one of the two ends.
            let a = far(at(rim[0]))?;
            let b = far(at(a))?;
            if at(b).y < at(a).y { b } else { a }
        };
        let tip = at(far(at(root))?) - at(root);
        let along = (tip - normal * tip.dot(normal)).try_normalize()?;
        let right = along.cross(normal);
        let scale = 1.0 / tip.dot(along);
        let local = |p: &DVec3| {
            let d = (*p - at(root)) * scale;
            DVec3::new(d.dot(right), d.dot(along), d.dot(normal))
        };
        let all: Vec<DVec3> = self.points.iter().map(local).collect();
        if !scale.is_finite() || all.iter().any(|p| !p.is_finite()) {
            return None;
        }
        Some(FlatSheet {
            points: all.iter().map(|p| p.truncate()).collect(),
            heights: all.iter().map(|p| p.z).collect(),
        })
    }
}

/// A sheet laid into its plane by projection, of length 1.
struct FlatSheet {
    points: Vec<DVec2>,
    heights: Vec<f64>,
}

impl FlatSheet {
    /// Fits bend and fold by least squares: height = tilt y - B y^2 + fold |x| over the root. The tilt is that of the
    /// plane against the leaf's direction at its root; the plant determines that direction.
    fn relief(&self) -> Relief {
        let start = self.points.iter().zip(&self.heights).filter(|(p, _)| p.length() < 0.05);
        let (sum, n) = start.fold((0.0, 0.0), |(s, n), (_, z)| (s + z, n + 1.0));
        let ground = if n > 0.0 { sum / n } else { 0.0 };
        let (mut square, mut right) = (DMat3::ZERO, DVec3::ZERO);
        for (p, z) in self.points.iter().zip(&self.heights) {
            let row = DVec3::new(p.y, -p.y * p.y, p.x.abs());
            square += DMat3::from_cols(row * row.x, row * row.y, row * row.z);
            right += row * (z - ground);
        }
        let scale = square.x_axis.x.max(square.y_axis.y).max(square.z_axis.z);
        let mut relief = Relief { keep_length: true, ..Relief::default() };
        if square.determinant() > 1e-9 * scale * scale * scale {
            let found = square.inverse() * right;
            relief.bend_b = found.y.clamp(-0.5, 0.8);
            relief.fold = found.z.clamp(-1.0, 1.0);
        }
        relief
    }

    /// Draws the picture of the model in the blade's chart, each triangle in its place.
    fn painted(&self, mesh: &TriMesh, welded: &[u32], picture: &Texture, blade: &Blade) -> Texture {
        let chart = skin::BladeChart::new(blade);
        let (width, height) = chart_size(&chart);
        let size = DVec2::new(f64::from(width), f64::from(height));
        let mut pixels: Vec<Option<[u8; 4]>> = vec![None; (width * height) as usize];
        for t in &mesh.triangles {
            let corner = |k: u32| -> Option<(DVec2, DVec2)> {
                let p = *self.points.get(*welded.get(k as usize)? as usize)?;
                let uv = mesh.uvs.get(k as usize)?.map(f64::from);
                Some((chart.uv(p) * size, DVec2::from_array(uv)))
            };
            let [Some(a), Some(b), Some(c)] = t.map(corner) else { continue };
            let area = (b.0 - a.0).perp_dot(c.0 - a.0);
            if area.abs() < 1e-9 {
                continue;
            }
            let low = a.0.min(b.0).min(c.0).floor().max(DVec2::ZERO);
            let high = a.0.max(b.0).max(c.0).ceil().min(size - 1.0);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the picture")]
            let [x0, y0, x1, y1] = [low.x, low.y, high.x, high.y].map(|x| x.max(0.0) as u32);
            for y in y0..=y1 {
                for x in x0..=x1 {
                    let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                    let (u, v) = ((p - a.0).perp_dot(c.0 - a.0) / area, (b.0 - a.0).perp_dot(p - a.0) / area);
                    if u >= -0.02 && v >= -0.02 && u + v <= 1.02 {
                        let uv = a.1 + (b.1 - a.1) * u + (c.1 - a.1) * v;
                        pixels[(y * width + x) as usize] = Some(sample(picture, uv));
                    }
                }
            }
        }
        // Beyond the outline each row continues with its nearest colour, so that no seam shows at the margin.
        let mut out = Texture { width, height, pixels: Vec::with_capacity(4 * pixels.len()) };
        let mut last = [96, 128, 64, 255];
        for line in pixels.chunks(width as usize) {
            last = line.iter().flatten().next().copied().unwrap_or(last);
            for pixel in line {
                last = pixel.unwrap_or(last);
                out.pixels.extend(last);
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Makes a rhombic leaf of a grid, its root at the origin, its tip on -Z, upper side up, sagging.
    fn sheet() -> TriMesh {
        let mut mesh = TriMesh::default();
        for i in 0..=8_u32 {
            for j in 0..=4_u32 {
                let y = f64::from(i) / 8.0;
                let wide = 0.05 * (1.0 - (2.0 * y - 1.0).abs());
                let x = wide * (f64::from(j) - 2.0) / 2.0;
                mesh.push(DVec3::new(x, -0.04 * y * y, -0.2 * y));
                #[expect(clippy::cast_possible_truncation, reason = "a test's texture coordinates")]
                mesh.uvs.push([j as f32 / 4.0, 1.0 - y as f32]);
            }
        }
        for i in 0..8 {
            for j in 0..4 {
                let a = 5 * i + j;
                mesh.triangles.push([a, a + 1, a + 6]);
                mesh.triangles.push([a, a + 6, a + 5]);
            }
        }
        mesh
    }

    fn model(mesh: TriMesh) -> Model {
        let mut model = Model::default();
        let mut material = mesh::Material::plain("leaf", MaterialKind::Leaf, [1.0; 3]);
        material.texture = Some(Arc::new(Texture { width: 1, height: 1, pixels: vec![9, 8, 7, 255] }));
        model.materials.push(material);
        model.parts.push(mesh::Part { name: "leaf".into(), material: mesh::MaterialId::new(0), mesh });
        model
    }

    #[test]
    fn model_of_a_leaf_becomes_a_blade_of_length_1() {
        let template = LeafTemplate::from_model(&model(sheet())).unwrap();
        let blade = &template.blade;
        assert!(blade.outline[0].length() < 1e-6, "{:?}", blade.outline[0]);
        assert!((blade.length() - 1.0).abs() < 1e-12);
        let area = geom::signed_area(&blade.outline);
        // A rhombus 1 long and 0.49 wide: half of the box.
        assert!((area - 0.245).abs() < 0.01, "{area}");
        assert!(blade.relief.bend_b > 0.05, "{:?}", blade.relief);
        assert_eq!(template.texture.as_ref().unwrap().pixels[..4], [9, 8, 7, 255]);
    }

    #[test]
    fn what_is_no_leaf_is_told() {
        assert_eq!(LeafTemplate::from_model(&Model::default()), Err(TemplateError::NoSurface));
        let mut solid = TriMesh::default();
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| solid.push(p));
        let [a, b, c, d] = corners;
        solid.triangles = vec![[a, c, b], [a, b, d], [a, d, c], [b, c, d]];
        assert_eq!(LeafTemplate::from_model(&model(solid)), Err(TemplateError::Closed));
    }
}
