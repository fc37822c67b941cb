//! Meshes organs: each shape is triangulated once, its organs are moved and tinted copies.

use std::borrow::Cow;
use std::sync::Arc;

use base::{Cancelled, Counted, Draw, Run, Stopped, map_indexed};
use glam::DVec3;
use mesh::TriMesh;
use plant::{Organ, OrganKind, Plant, Shape, ShapeId};

use crate::LeafMeshSpec;
use crate::blade::blade_mesh;
use crate::body::{bent, dome, prism, revolution, rod, strand};
use crate::layout::Piece;
use crate::leaf::{ShapeMesh, sheet_mesh, spline_mesh};
use crate::lean::{COPIED_WIDER, fewer_corners, lean_mesh};
use crate::margin::from_margin;
use crate::material::{Pattern, Wearer};
use crate::parts::{Coat, Slot};
use crate::shoots::{Tile, card_mesh, leaf_share, part};
use crate::sleeve::{narrow, wide};
use crate::spec::{Budget, PetalColor, SkinSpec};
use crate::traced::Traced;
use crate::wind::{Wind, flutter};

// Number of vertices in a group of copied organs: one job each would cost more than the copy.
const GROUP: usize = 6000;

/// Makes the organs' meshes, collected by slot in the order of the organs. `wood`: number of triangles that exist
/// already.
///
/// # Errors
/// [`Stopped`].
pub(crate) fn organs(
    plant: &Plant,
    spec: &SkinSpec,
    budget: &Budget,
    (traced, wood): (Option<&Traced>, usize),
    wind: Option<&Wind<'_>>,
    kept: Option<&mut KeptShapes>,
    run: &Run<'_>,
) -> Result<Vec<(Slot, TriMesh, Vec<Piece>)>, Stopped> {
    let uses = uses(plant);
    let ground = Ground::new(plant, spec);
    let of_photo = |o: &Organ| traced.filter(|t| t.has(o.source));
    let known = kept.as_deref();
    let shapes = map_indexed(run.executor, plant.shapes.len(), |i| {
        run.cancel.check()?;
        let shape = &plant.shapes[i];
        let wish = uses[i].map_or(Wish::Nothing, |used| ground.wish((i, shape), used, budget));
        let known = known.and_then(|k| k.find(shape, wish, i));
        Ok(known.unwrap_or_else(|| (wish, Arc::new(wish.mesh(shape)))))
    });
    let made: Vec<Made> = shapes.into_iter().collect::<Result<_, Cancelled>>()?;
    if let Some(kept) = kept {
        kept.replace(&plant.shapes, &made);
    }
    let shapes: Vec<Arc<ShapeMesh>> = made.into_iter().map(|(_, mesh)| mesh).collect();
    let margins = margins(plant, spec, &shapes, run)?;
    let flutters: Vec<[Vec<f32>; 2]> = match wind {
        Some(_) => {
            let both = |(s, m): (&Shape, &Arc<ShapeMesh>)| [&m.surface, &m.veins].map(|m| flutter(s, m));
            plant.shapes.iter().zip(&shapes).map(both).collect()
        }
        None => Vec::new(),
    };
    let mesh_of = |&(_, i, layer): &Copied| match layer {
        Layer::Surface => &shapes[plant.organs[i].shape.index()].surface,
        Layer::Veins => &shapes[plant.organs[i].shape.index()].veins,
    };
    let placed = |(i, o): (usize, &Organ)| {
        let shape = &plant.shapes[o.shape.index()];
        let slot = match *shape {
            Shape::Spline(ref blade) => Slot::Form(blade.form, Coat::choose(o.paint, shape)),
            Shape::Sheet(ref sheet) if sheet.form.is_some() => {
                Slot::Form(sheet.form.unwrap_or_default(), Coat::choose(o.paint, shape))
            }
            _ => ground.slot(o, shape),
        };
        let veins = if matches!(shape, Shape::Sheet(s) if s.form.is_some()) { slot } else { Slot::Veins };
        let slot = match spec.worn.material(o) {
            Some((wearer, row)) => Slot::Worn(wearer, row),
            None if of_photo(o).is_some() => slot.traced(),
            None => slot,
        };
        [(slot, i, Layer::Surface), (veins, i, Layer::Veins)]
    };
    let organs = plant.organs.iter().enumerate();
    let organs = organs.filter(|(_, o)| o.shape.index() < shapes.len() && sound(o));
    let mut order: Vec<Copied> =
        organs.flat_map(placed).filter(|c| !mesh_of(c).triangles.is_empty()).collect();
    let blades = order.iter().map(|c| mesh_of(c).triangles.len());
    run.budget.check(Counted::Triangles, (wood + blades.sum::<usize>()) as u64, crate::FEWER)?;
    base::sort_by_key(&mut order, |&(slot, ..)| slot);
    let groups = groups(&order, |c| mesh_of(c).positions.len());
    let meshes = map_indexed(run.executor, groups.len(), |g| {
        run.cancel.check()?;
        let members = &order[groups[g].clone()];
        let mut mesh = TriMesh::default();
        let vertices: usize = members.iter().map(|c| mesh_of(c).positions.len()).sum();
        mesh.positions.reserve_exact(vertices);
        mesh.normals.reserve_exact(vertices);
        mesh.uvs.reserve_exact(vertices);
        mesh.colors.reserve_exact(vertices);
        if wind.is_some() {
            mesh.wind.reserve_exact(vertices);
            mesh.pivots.reserve_exact(vertices);
        }
        for copied in members {
            let &(slot, i, layer) = copied;
            let organ = &plant.organs[i];
            let first = mesh.positions.len();
            let photo = if let Slot::Traced(_) = slot { of_photo(organ) } else { None };
            let color =
                if photo.is_some() || slot == Slot::Veins { [1.0; 3] } else { tint(organ, slot, spec) };
            place(&mut mesh, mesh_of(copied), organ, color);
            if let Some(photo) = photo {
                photo.organ(&mut mesh, first);
            }
            if let Slot::Worn(_, row) = slot {
                // These replace the colours that the shape has itself.
                mesh.colors[first..].fill(color);
                let margin = &margins[organ.shape.index()];
                if spec.worn.cloths[row].material.pattern.follows_margin() && !margin.is_empty() {
                    for (uv, &inner) in mesh.uvs[first..].iter_mut().zip(margin) {
                        uv[0] = inner;
                    }
                }
            }
            if let Some(wind) = wind {
                wind.organ(&mut mesh, first, organ, &flutters[organ.shape.index()][layer as usize]);
            }
        }
        let pieces = members.iter().map(|c| Piece::organ(c.1, mesh_of(c).triangles.len()));
        Ok((members[0].0, mesh, pieces.collect()))
    });
    Ok(meshes.into_iter().collect::<Result<_, Cancelled>>()?)
}

/// Returns a value for each shape as it is drawn at scale 1; the default for an unused one.
fn map_shapes<T: Default>(
    plant: &Plant,
    spec: &SkinSpec,
    budget: &Budget,
    of: impl Fn(ShapeMesh, f64) -> T,
) -> Vec<T> {
    let ground = Ground::new(plant, spec);
    let drawn = |((row, shape), used): ((usize, &Shape), Option<Use>)| {
        used.map(|used| {
            let wish = ground.wish((row, shape), used, budget);
            of(wish.mesh(shape), ground.share(wish, (row, shape)))
        })
        .unwrap_or_default()
    };
    plant.shapes.iter().enumerate().zip(uses(plant)).map(drawn).collect()
}

/// Returns the mesh of each shape as it is drawn at scale 1, including its veins; empty for an unused one.
pub(crate) fn meshes(plant: &Plant, spec: &SkinSpec, budget: &Budget) -> Vec<TriMesh> {
    map_shapes(plant, spec, budget, |made, _| {
        let mut all = TriMesh::default();
        for mesh in [made.surface, made.veins] {
            all.append(&TriMesh { uvs: Vec::new(), colors: Vec::new(), ..mesh.clone() });
            all.uvs.extend_from_slice(&mesh.uvs);
            all.uvs.resize(all.positions.len(), [0.0; 2]);
        }
        all
    })
}

/// Returns the vertices of each shape as it is drawn at scale 1; empty for an unused one.
pub(crate) fn vertices(plant: &Plant, spec: &SkinSpec, budget: &Budget) -> Vec<Vec<DVec3>> {
    map_shapes(plant, spec, budget, |made, _| {
        made.surface.positions.iter().map(|p| DVec3::from(p.map(f64::from))).collect()
    })
}

/// Returns the triangles of the surface of each shape; 0 for an unused one.
pub(crate) fn triangles(plant: &Plant, spec: &SkinSpec, budget: &Budget) -> Vec<usize> {
    map_shapes(plant, spec, budget, |made, _| made.surface.triangles.len())
}

/// Returns the area of each shape as it is drawn at scale 1, one side, without its holes, square metres; 0 for an
/// unused one.
pub(crate) fn areas(plant: &Plant, spec: &SkinSpec, budget: &Budget) -> Vec<f64> {
    map_shapes(plant, spec, budget, |made, share| {
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| made.surface.position(i));
            0.5 * (b - a).cross(c - a).length()
        };
        share * made.surface.triangles.iter().map(area).sum::<f64>()
    })
}

/// Returns the distance of each vertex of a shape from the margin, for shapes with a pattern of the margin; empty for
/// others.
fn margins(
    plant: &Plant,
    spec: &SkinSpec,
    shapes: &[Arc<ShapeMesh>],
    run: &Run<'_>,
) -> Result<Vec<Vec<f32>>, Stopped> {
    let mut wanted = vec![false; shapes.len()];
    for organ in &plant.organs {
        let worn = spec.worn.material(organ).map(|(_, row)| spec.worn.cloths[row].material.pattern);
        if let Some(wanted) = wanted.get_mut(organ.shape.index()) {
            *wanted |= worn.is_some_and(Pattern::follows_margin);
        }
    }
    let made = map_indexed(run.executor, shapes.len(), |i| {
        run.cancel.check()?;
        Ok(if wanted[i] { from_margin(&plant.shapes[i], &shapes[i].surface) } else { Vec::new() })
    });
    Ok(made.into_iter().collect::<Result<_, Cancelled>>()?)
}

/// Meshes a blade with few triangles; `None` if more are requested than corners alone can use.
fn lean(blade: &plant::Blade, wish: f64, widest: f64) -> Option<TriMesh> {
    (wish <= 60.0).then(|| lean_mesh(blade, wish, widest)).flatten()
}

/// Returns a blade whose margin has few enough corners for this number of triangles.
fn plain(blade: &plant::Blade, triangles: f64) -> Cow<'_, plant::Blade> {
    let most = base::ops::whole(0.5 * triangles).max(8) as usize;
    match fewer_corners(blade, most) {
        Some(outline) => Cow::Owned(plant::Blade { outline, ..blade.clone() }),
        None => Cow::Borrowed(blade),
    }
}

fn sound(organ: &Organ) -> bool {
    let f = &organ.frame;
    let axes = f.right.is_finite() && f.along.is_finite() && f.normal.is_finite();
    axes && f.origin.is_finite() && organ.scale.is_finite() && organ.scale > 0.0
}

/// Use of a shape.
#[derive(Clone, Copy, Debug, Default)]
struct Use {
    /// The largest scale.
    scale: f64,
    /// Whether it is used for a body.
    body: bool,
    /// Whether it is used for leaves alone.
    leaf: bool,
}

/// Returns the use of each shape; `None` for an unused one.
fn uses(plant: &Plant) -> Vec<Option<Use>> {
    let mut uses = vec![None; plant.shapes.len()];
    for organ in plant.organs.iter().filter(|o| sound(o)) {
        if let Some(used) = uses.get_mut(organ.shape.index()) {
            let Use { scale, body, leaf } = used.unwrap_or(Use { leaf: true, ..Use::default() });
            *used = Some(Use {
                scale: organ.scale.max(scale),
                body: body || organ.kind == OrganKind::Body,
                leaf: leaf && organ.kind == OrganKind::Leaf,
            });
        }
    }
    uses
}

/// The surface of an organ's shape, or its veins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Layer {
    Surface,
    Veins,
}

/// One mesh of a shape for one organ.
type Copied = (Slot, usize, Layer);

/// Runs of one slot with about [`GROUP`] vertices each.
fn groups(order: &[Copied], vertices: impl Fn(&Copied) -> usize) -> Vec<core::ops::Range<usize>> {
    let mut out = Vec::new();
    let (mut start, mut held) = (0, 0);
    for (k, copied) in order.iter().enumerate() {
        if k > start && (held > GROUP || copied.0 != order[start].0) {
            out.push(start..k);
            (start, held) = (k, 0);
        }
        held += vertices(copied);
    }
    if start < order.len() {
        out.push(start..order.len());
    }
    out
}

/// Resolution of a shape: everything other than the shape on which its mesh depends. Numbers of triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Wish {
    Nothing,
    /// A leaf of a crown, with the largest factor on its width.
    Lean(f64, f64),
    /// A card, in this part of an atlas.
    Card([f64; 4]),
    Sheet(f64),
    /// For a coarser copy: without teeth that alone would be more triangles.
    Plain(f64),
    Dome(f64),
    /// With the least number of sides.
    Revolution(f64, u32),
    /// A body along a line.
    Bent(f64, u32),
    Strand {
        fine: bool,
    },
    /// A strand of a crown.
    Prism,
    /// A strand of a plant that is shown on several days.
    Rod,
    Spline(LeafMeshSpec),
    /// With this detail.
    Grid(LeafMeshSpec, f64),
}

impl Wish {
    /// Whether it differs by less than a tenth.
    fn nearly(self, other: Self) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() < 0.1 * a.max(b);
        match (self, other) {
            (Self::Lean(a, m), Self::Lean(b, n)) => m == n && near(a, b),
            (Self::Sheet(a), Self::Sheet(b))
            | (Self::Plain(a), Self::Plain(b))
            | (Self::Dome(a), Self::Dome(b)) => near(a, b),
            (Self::Revolution(a, m), Self::Revolution(b, n)) | (Self::Bent(a, m), Self::Bent(b, n)) => {
                m == n && near(a, b)
            }
            _ => self == other,
        }
    }

    fn mesh(self, shape: &Shape) -> ShapeMesh {
        match (self, shape) {
            (Self::Spline(spec), Shape::Spline(blade)) => return spline_mesh(blade, &spec),
            (Self::Grid(spec, detail), Shape::Sheet(sheet)) => return sheet_mesh(sheet, &spec, detail),
            (Self::Lean(n, widest), Shape::Blade(blade)) => {
                lean(blade, n, widest).unwrap_or_else(|| blade_mesh(blade, n))
            }
            (Self::Card(part), Shape::Blade(blade)) => card_mesh(blade, part),
            (Self::Sheet(n), Shape::Blade(blade)) => blade_mesh(blade, n),
            (Self::Plain(n), Shape::Blade(blade)) => blade_mesh(&plain(blade, n), n),
            (Self::Dome(n), Shape::Dome { radius_m, height_m }) => dome(*radius_m, *height_m, n),
            (Self::Revolution(n, sides), Shape::Revolution { profile }) => revolution(profile, n, sides),
            (Self::Bent(n, sides), Shape::Strand { path, radius_m, .. }) => bent(path, radius_m, n, sides),
            (Self::Strand { fine }, Shape::Strand { path, radius_m, knob_m }) => {
                let knob = if knob_m.is_finite() { *knob_m } else { 0.0 };
                strand(path, radius_m, knob, fine)
            }
            (Self::Rod, Shape::Strand { path, radius_m, .. }) => rod(path, radius_m),
            (Self::Prism, Shape::Strand { path, radius_m, .. }) => prism(path, radius_m),
            _ => TriMesh::default(),
        }
        .into()
    }
}

/// The meshes of a plant's leaves, petals and other shapes, reused for the next surface of the same plant if the shapes
/// did not change.
///
/// Guaranteed, except for [`loose`](Self::loose): the result is the same with and without.
#[derive(Clone, Debug, Default)]
pub struct KeptShapes {
    shapes: Vec<Shape>,
    made: Vec<Made>,
    loose: bool,
}

/// A shape's mesh and the wish that it was made by.
type Made = (Wish, Arc<ShapeMesh>);

impl KeptShapes {
    /// Rows that are examined before and after a shape's own: a stroke adds few shapes.
    const AROUND: usize = 16;
    /// Most shapes that are kept: more would take the memory of another plant.
    const MOST: usize = 4096;

    /// Makes a cache for previews of a plant that is still being drawn: it also reuses meshes with up to a tenth more
    /// or less triangles than a fresh one would have. A growing stroke changes the plant's size slightly at every
    /// preview.
    #[must_use]
    pub fn loose() -> Self {
        Self { loose: true, ..Self::default() }
    }

    /// Returns the mesh of a shape of the plant that was meshed last, in the shape's own frame.
    pub fn get(&self, shape: ShapeId) -> Option<&ShapeMesh> {
        self.made.get(shape.index()).map(|(_, mesh)| &**mesh)
    }

    fn find(&self, shape: &Shape, wish: Wish, row: usize) -> Option<Made> {
        let rows = row.saturating_sub(Self::AROUND)..self.made.len().min(row + Self::AROUND + 1);
        let same = |&row: &usize| {
            let (Some(old), Some((was, _))) = (self.shapes.get(row), self.made.get(row)) else {
                return false;
            };
            (wish == *was || (self.loose && wish.nearly(*was))) && old == shape
        };
        // Its own row first: it is usually there.
        let found = core::iter::once(row).chain(rows).find(same)?;
        self.made.get(found).cloned()
    }

    fn replace(&mut self, shapes: &[Shape], made: &[Made]) {
        let few = shapes.len() <= Self::MOST;
        self.shapes = if few { shapes.to_vec() } else { Vec::new() };
        self.made = if few { made.to_vec() } else { Vec::new() };
    }
}

/// Ribs of a cactus.
const RIBS: u32 = 16;

/// Most leaves that do not form a crown.
const FEW_LEAVES: usize = 1500;

/// Decisions for the plant as a whole that affect its organs.
struct Ground<'a> {
    /// Decides which leaves are cards.
    spec: &'a SkinSpec,
    petals: PetalColor,
    /// Whether stamens and thorns are few enough to give each more than three rings.
    fine_strands: bool,
    leaf: LeafMeshSpec,
    /// Whether the triangles must be the same on every day.
    steady: bool,
    /// Whether it is a coarser copy.
    copy: bool,
    /// Whether a plant of many flowers has so few leaves that each is noticed: they bend.
    few_leaves: bool,
}

impl<'a> Ground<'a> {
    fn new(plant: &Plant, spec: &'a SkinSpec) -> Self {
        let strands = plant
            .organs
            .iter()
            .filter(|o| matches!(o.kind, OrganKind::Stamen | OrganKind::Pistil | OrganKind::Thorn))
            .count();
        Self {
            spec,
            petals: PetalColor::for_plant(plant, spec),
            fine_strands: strands <= 40,
            leaf: spec.leaf,
            steady: spec.steady_m.is_some(),
            copy: spec.crowd.is_some(),
            few_leaves: spec.crowd.is_none()
                && plant.organs.iter().filter(|o| o.kind == OrganKind::Leaf).count() <= FEW_LEAVES,
        }
    }

    /// Returns the share of a card that is leaf, 0 to 1; 1 for everything else.
    fn share(&self, wish: Wish, (row, shape): (usize, &Shape)) -> f64 {
        match (wish, self.tile(row), shape) {
            (Wish::Card(_), Some((_, tile)), _) => tile.share(),
            (Wish::Card(_), None, Shape::Blade(blade)) => leaf_share(blade),
            _ => 1.0,
        }
    }

    fn tile(&self, row: usize) -> Option<(usize, &Tile)> {
        self.spec.shoots.as_ref()?.tile(row)
    }

    fn wish(&self, (row, shape): (usize, &Shape), used: Use, budget: &Budget) -> Wish {
        let scale = used.scale;
        if let (Shape::Blade(blade), true) = (shape, used.leaf) {
            let needled = blade.needles.is_some();
            if self.spec.cards(needled) {
                let cell = self.tile(row).map_or(0, |(k, _)| k + 1);
                return Wish::Card(part(cell, self.spec.cells(needled)));
            }
        }
        let triangles = |area: f64| budget.blade_triangles(area * scale * scale);
        match shape {
            Shape::Blade(blade) => {
                let area = geom::signed_area(&blade.outline).abs();
                // A toothed or lobed margin (perimeter^2 / area of 30 to 300, 12 for a plain leaf) needs edges.
                let around = crate::blade::closed_length(&blade.outline);
                let least = (4.0 * around / area.max(f64::MIN_POSITIVE).sqrt()).clamp(14.0, 40.0);
                if budget.crown() && !(used.leaf && self.few_leaves) {
                    return Wish::Lean(
                        budget.lean_triangles(least),
                        if self.copy { COPIED_WIDER } else { plant::DRAWN_WIDER },
                    );
                }
                let wanted = triangles(area).max(least * budget.detail.min(1.0));
                // With few triangles none may be spent inside of the form.
                if self.copy && wanted <= 60.0 {
                    return Wish::Lean(wanted, COPIED_WIDER);
                }
                if self.copy { Wish::Plain(wanted) } else { Wish::Sheet(wanted) }
            }
            // A dome is smooth: two fifths of the triangles of a blade of its size.
            Shape::Dome { radius_m, height_m } if radius_m.is_finite() && height_m.is_finite() => {
                Wish::Dome(0.4 * triangles(base::ops::PI * radius_m * radius_m))
            }
            Shape::Revolution { profile } => {
                let area = |w: &[glam::DVec2]| (w[0].x + w[1].x) * w[0].distance(w[1]);
                let area: f64 = profile.windows(2).map(area).filter(|a| a.is_finite()).sum();
                if used.body {
                    Wish::Revolution(4.0 * triangles(area), RIBS)
                } else {
                    Wish::Revolution(triangles(area), 0)
                }
            }
            Shape::Strand { path, radius_m, .. } if shape.is_bent_body() => {
                let piece = |(p, r): (&[DVec3], &[f64])| (r[0] + r[1]) * p[0].distance(p[1]);
                let pieces = path.windows(2).zip(radius_m.windows(2)).map(piece);
                let area: f64 = pieces.filter(|a| a.is_finite()).sum();
                if used.body {
                    Wish::Bent(4.0 * triangles(area), RIBS)
                } else {
                    Wish::Bent(triangles(area), 0)
                }
            }
            Shape::Strand { knob_m: 0.0, .. } if self.steady => Wish::Rod,
            Shape::Strand { knob_m: 0.0, .. } if budget.crown() || self.copy => Wish::Prism,
            Shape::Strand { .. } => Wish::Strand { fine: self.fine_strands && budget.detail >= 0.5 },
            Shape::Spline(_) => Wish::Spline(self.leaf.with_detail(budget.detail)),
            Shape::Sheet(_) => Wish::Grid(self.leaf.with_detail(budget.detail), budget.detail),
            _ => Wish::Nothing,
        }
    }

    fn slot(&self, organ: &Organ, shape: &Shape) -> Slot {
        let coat = Coat::choose(organ.paint, shape);
        match organ.kind {
            OrganKind::Petal => Slot::Petal(coat, self.petals),
            OrganKind::Sepal => Slot::Sepal(coat),
            OrganKind::Disc | OrganKind::Floret => Slot::Disc(coat),
            OrganKind::Body if coat == Coat::Natural => Slot::Body,
            OrganKind::Syncarp if coat == Coat::Natural => Slot::Syncarp,
            OrganKind::Fruit | OrganKind::Syncarp | OrganKind::Body => Slot::Fruit(coat),
            OrganKind::Stamen | OrganKind::Anther | OrganKind::Pistil => Slot::Stamen(coat),
            OrganKind::Pot => Slot::Pot,
            OrganKind::Thorn => Slot::Thorn,
            OrganKind::Pedicel => Slot::Stem,
            _ if matches!(shape, Shape::Blade(b) if b.needles.is_some()) => Slot::Needles(coat),
            _ => Slot::Leaf(coat),
        }
    }
}

/// Returns the vertex colour of an organ: its paint, varied slightly in brightness and hue.
fn tint(organ: &Organ, slot: Slot, spec: &SkinSpec) -> [f32; 3] {
    let mut draw = spec.seed.child(organ.key).stream(Draw::Tint);
    let (light, warm) = (draw.uniform(), draw.uniform());
    let strength = spec.variation.clamp(0.0, 1.0);
    // Leaves of one plant differ more than its petals do.
    let (light, warm) = match slot {
        Slot::Leaf(_) | Slot::Needles(_) | Slot::Worn(Wearer::Leaf, _) => (0.26 * light, 0.24 * (warm - 0.5)),
        _ => (0.12 * light, 0.08 * (warm - 0.5)),
    };
    let [light, warm] = [light, warm].map(|x| x * strength);
    let own = match organ.kind {
        // The stamens' texture in the green of a pistil.
        OrganKind::Pistil if slot == Slot::Stamen(Coat::Natural) => [0.62, 0.86, 0.42],
        _ => [1.0; 3],
    };
    // A material keeps its colours; only the variation of its plant applies.
    let paint = if let Slot::Worn(..) = slot { [1.0; 3] } else { organ.paint.rgb() };
    let hue = [1.0 + warm.min(0.0), 1.0, 1.0 - 0.9 * warm.abs()];
    [0, 1, 2].map(|i| {
        let given = if paint[i].is_finite() { f64::from(paint[i]) } else { 1.0 };
        #[expect(clippy::cast_possible_truncation, reason = "a colour of the mesh")]
        let x = (given * own[i] * hue[i] * (1.0 - light)).clamp(0.0, 1.0) as f32;
        x
    })
}

/// Appends a moved and coloured copy of `local`.
fn place(out: &mut TriMesh, local: &TriMesh, organ: &Organ, color: [f32; 3]) {
    let first = crate::sleeve::index(out.positions.len());
    let f = &organ.frame;
    out.positions.extend(local.positions.iter().map(|&p| narrow(f.place(wide(p), organ.scale))));
    out.normals.extend(local.normals.iter().map(|&n| narrow(f.rotate(wide(n)))));
    out.uvs.extend_from_slice(&local.uvs);
    out.uvs.resize(out.positions.len(), [0.0; 2]);
    let times = |c: &[f32; 3]| [0, 1, 2].map(|i| c[i] * color[i]);
    out.colors.extend(local.colors.iter().map(times));
    out.colors.resize(out.positions.len(), color);
    out.triangles.extend(local.triangles.iter().map(|t| t.map(|i| i + first)));
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use plant::{Blade, Lift, Relief};

    fn leaf(length: f64) -> Shape {
        let midrib = vec![DVec2::ZERO, DVec2::new(0.0, length)];
        let outline =
            [(0.0, 0.0), (0.3, 0.5), (0.0, 1.0), (-0.3, 0.5)].map(|(x, y)| DVec2::new(x, y) * length);
        let (veins, lift, relief) = (Vec::new(), Lift::Flat, Relief::default());
        Shape::Blade(Blade { outline: outline.to_vec(), midrib, veins, needles: None, lift, relief })
    }

    #[test]
    fn shapes_that_stay_are_taken_over_and_others_are_not() {
        let wish = Wish::Sheet(60.0);
        let shapes = [leaf(1.0), leaf(2.0), leaf(3.0)];
        let made: Vec<Made> = shapes.iter().map(|s| (wish, Arc::new(wish.mesh(s)))).collect();
        for mut kept in [KeptShapes::default(), KeptShapes::loose()] {
            kept.replace(&shapes, &made);
            let found = |length, wish, row| kept.find(&leaf(length), wish, row);
            let is = |found: Option<Made>, row: usize| found.is_some_and(|m| Arc::ptr_eq(&m.1, &made[row].1));
            assert!(is(found(3.0, wish, 2), 2));
            // A shape before it was added or removed.
            assert!(is(found(3.0, wish, 1), 2) && is(found(1.0, wish, 9), 0));
            assert!(found(1.5, wish, 0).is_none() && found(1.0, Wish::Sheet(70.0), 0).is_none());
            // As it was first made, so that small steps do not accumulate.
            let near = found(1.0, Wish::Sheet(61.0), 0);
            assert_eq!(near.map(|m| m.0), kept.loose.then_some(wish));
            let many = vec![leaf(1.0); KeptShapes::MOST + 1];
            kept.replace(&many, &vec![made[0].clone(); many.len()]);
            assert!(kept.find(&leaf(1.0), wish, 0).is_none());
        }
    }
}
