//! The whole way from a reading to a plant.
//!
//! `Reading -> AxisPlans with depth -> axes -> leaves, flowers, thorns, fruits -> filled contours -> radii`

use base::{Cancelled, LiteMap, Report, Run, Seed};
use geom::contains;
use glam::{DVec2, DVec3};
use plant::{AxisId, AxisKind, NodeId, PipeModel, Plant, ShapeId, Taper, pipe_radii};
use reading::{BladeReading, FruitReading, Reading, RegionKind};

use crate::bodies::name_bodies;
use crate::depth::{
    Bearing, LocalBlade, Part, Plans, Scene, bend_by_light_and_weight, blade_key, branch_depths, coloured,
    fill_bunches, leaf_shape, place_flower, place_fruit, place_leaf, place_pot, place_thorn, usual_colour,
};
use crate::fill::{FillContext, GrownContour, KeptBodies, fill};
use crate::front::Front;
use crate::{PlantMap, SketchSpec};

/// A plant and its place in the drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Built {
    /// The plant: `plant.validate()` finds no fault in it.
    pub plant: Plant,
    /// From the drawing's ink to the plant's metres.
    pub map: PlantMap,
    /// Results of growth in the drawing's contours.
    pub grown: Vec<GrownContour>,
}

/// Builds the plant of a reading.
///
/// `reading`: whatever [`read`](reading::read) or a caller made; coordinates that are not finite, lines without
/// length and references to rows that are not there are left out. Guaranteed: the same plant for the same reading,
/// spec and seed, on every platform; a clean `validate()`; with `leaf_depth` drawn, light and weight 0, the front
/// view of axes, petals and leaves is the drawing. Not guaranteed: that anything is left of a reading of nothing.
/// Books its time under `depth`. He and Cheng (2021), sections 4.3 to 6.
///
/// # Errors
/// [`Cancelled`] when the caller asked to stop.
///
/// ```
/// use base::{Report, Run, Seed};
/// use glam::DVec2;
/// use plant::AxisKind;
/// use reading::{AxisReading, Reading};
/// use sketch::{SketchSpec, build};
/// let stem = AxisReading {
///     points: vec![DVec2::new(0.2, 0.0), DVec2::new(0.2, 0.5)],
///     kind: AxisKind::Stem,
///     bearer: None,
///     half_width: vec![],
///     source: Some(0),
/// };
/// let reading = Reading { axes: vec![stem], ..Reading::default() };
/// let built = build(&reading, &SketchSpec::default(), Seed::new(1), &Run::plain(), &mut Report::default())?;
/// let top = built.plant.axis_points(built.plant.nodes.axis[0]).last().copied();
/// assert!(top.is_some_and(|p| (p.y - 0.5).abs() < 1e-12)); // a herb of half a metre
/// # Ok::<(), base::Cancelled>(())
/// ```
pub fn build(
    reading: &Reading,
    spec: &SketchSpec,
    seed: Seed,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<Built, Cancelled> {
    build_again(reading, spec, seed, &mut KeptBodies::default(), run, report)
}

/// Builds a plant as [`build`] does, again for a reading that changed a little: results in `kept` from the last time
/// are not computed anew. The same plant comes out.
///
/// # Errors
/// Those of [`build`].
pub fn build_again(
    reading: &Reading,
    spec: &SketchSpec,
    seed: Seed,
    kept: &mut KeptBodies,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<Built, Cancelled> {
    run.cancel.check()?;
    if let Some(flip) = spec.flipped_flowers.iter().find(|&&i| i as usize >= reading.flowers.len()) {
        let flowers = reading.flowers.len();
        base::warn!(
            report,
            "no-such-flower",
            { flower = flip, count = flowers },
            "flower {flower} is to be flipped, but there are {count} flowers, numbered from 0"
        );
    }
    let started = run.clock.now_ms();
    let map = plant_map(reading, spec);
    let mut plans = Plans::new(reading);
    branch_depths(&mut plans, spec.branch_depth, seed);
    bend_by_light_and_weight(&mut plans, spec);
    run.cancel.check()?;

    let mut plant = Plant::default();
    let ids = add_axes(&mut plant, &plans, map);
    let blades = reading.leaves.iter().chain(reading.flowers.iter().flat_map(|f| &f.petals));
    let filled = reading.regions.iter().map(|r| r.color).chain(reading.fruits.iter().map(|f| f.color));
    let discs = reading.flowers.iter().filter_map(|f| f.disc.as_ref()).map(|d| d.color);
    let colors = blades.map(|b| b.color).chain(filled.clone()).chain(discs);
    let petals = reading.flowers.iter().flat_map(|f| &f.petals).filter_map(|p| p.color);
    let pots = reading.pots.iter().map(|p| p.color);
    let others = reading.leaves.iter().map(|l| l.color).chain(filled).chain(pots).flatten();
    let is_in_blue_pen = reading::is_in_blue_pen(petals, others);
    let pressed = base::map_of(reading.pressed.iter().copied().filter(|p| p.1.is_finite() && p.1 > 0.0));
    let scene = Scene {
        spec,
        seed,
        map,
        plans: &plans,
        ids: &ids,
        coloured: coloured(colors) && !is_in_blue_pen,
        petals: usual_colour(reading.flowers.iter().flat_map(|f| &f.petals)),
        pressed: &pressed,
    };
    let crowned = Crowned::new(reading);
    let leaves = leaf_shapes(&mut plant, &scene, reading);
    let templates: Vec<(ShapeId, Option<u32>)> = leaves.iter().map(|l| (l.shape, l.leaf.source)).collect();
    for leaf in leaves.iter().filter(|l| !crowned.holds(l.leaf.root)) {
        run.cancel.check()?;
        place_leaf(&mut plant, &scene, leaf.leaf, (leaf.shape, &leaf.local), leaf.key, None);
    }
    run.cancel.check()?;
    for (i, flower) in reading.flowers.iter().enumerate().filter(|(_, f)| !crowned.holds(f.centre)) {
        run.cancel.check()?;
        place_flower(&mut plant, &scene, i, flower, None);
    }
    for (i, thorn) in reading.thorns.iter().enumerate() {
        place_thorn(&mut plant, &scene, thorn, i);
    }
    let free = |f: &FruitReading| !crowned.holds(middle(&f.outline));
    for (i, placed) in fill_bunches(&reading.fruits).iter().enumerate() {
        if free(&reading.fruits[i]) {
            place_fruit(&mut plant, &scene, (&placed.fruit, placed.depth), i, None);
        }
    }
    reading.pots.iter().for_each(|pot| place_pot(&mut plant, &scene, pot));
    report.book("depth", run.clock.now_ms() - started);
    run.cancel.check()?;

    let ctx = FillContext {
        spec,
        seed,
        map,
        axis_of_reading: &ids,
        templates: &templates,
        height_m: height_m(reading, spec),
        woody: reading.woody,
        coloured: scene.coloured,
    };
    let grown = fill(&mut plant, reading, &ctx, kept, run, report)?;
    run.cancel.check()?;

    let started = run.clock.now_ms();
    hang_in_crowns(&mut plant, &scene, reading, &crowned, &leaves);
    let model = pipes(&plant, &plans, &ids, reading, spec, map);
    pipe_radii(&mut plant, &model);
    press(&mut plant, reading, pressed);
    name_bodies(&mut plant, reading);
    report.book("depth", run.clock.now_ms() - started);
    debug_assert_eq!(plant.validate().next(), None, "a built plant is sound");
    Ok(Built { plant, map, grown })
}

/// Thickens axes that were drawn boldly, and the axes that they bear; no axis becomes thicker than its bearer.
fn press(plant: &mut Plant, reading: &Reading, mut pressed: LiteMap<u32, f64>) {
    if pressed.is_empty() {
        return;
    }
    // An axis drawn as an outline has the width that was drawn.
    for axis in reading.axes.iter().filter(|a| !a.half_width.is_empty()) {
        axis.source.and_then(|source| pressed.remove(&source));
    }
    let mut by = vec![1.0; plant.axes.len()];
    for i in 0..plant.axes.len() {
        let axis = &plant.axes[i];
        let rows = axis.nodes.start as usize..axis.nodes.end as usize;
        let below =
            axis.bearer.map(|b| (plant.nodes.axis[b.index()].index(), plant.nodes.radius_m[b.index()]));
        let inherited = below.map_or(1.0, |(bearer, _)| by[bearer]);
        by[i] = axis.source.and_then(|s| pressed.get(&s).copied()).unwrap_or(inherited);
        let base = plant.nodes.radius_m.get(rows.start).copied().unwrap_or(0.0) * by[i];
        let most = below.map_or(f64::INFINITY, |(_, radius)| radius);
        let factor = if base > most && base > 0.0 { by[i] * most / base } else { by[i] };
        plant.nodes.radius_m[rows].iter_mut().for_each(|r| *r *= factor);
    }
}

/// Returns scale and origin: the main axis stands at x = 0 on the ground, and the plant has the requested height.
fn plant_map(reading: &Reading, spec: &SketchSpec) -> PlantMap {
    let sound = |p: &DVec2| p.is_finite() && p.abs().max_element() < 1e6;
    let standing = |a: &&reading::AxisReading| a.bearer.is_none() && a.kind != AxisKind::Root;
    let foot = |a: &reading::AxisReading| a.points.iter().copied().find(|p| sound(p));
    let length = |a: &reading::AxisReading| geom::polyline_length(&a.points);
    let main = reading
        .axes
        .iter()
        .filter(standing)
        .filter(|a| foot(a).is_some())
        .reduce(|a, b| if length(b) > length(a) { b } else { a });
    let blades = reading.leaves.iter().chain(reading.flowers.iter().flat_map(|f| &f.petals));
    let lines = (reading.axes.iter().map(|a| &a.points))
        .chain(blades.map(|b| &b.outline))
        .chain(reading.regions.iter().map(|r| &r.outline))
        .chain(reading.fruits.iter().map(|f| &f.outline));
    let (mut low, mut high) = (DVec2::splat(f64::INFINITY), DVec2::splat(f64::NEG_INFINITY));
    for p in lines.flatten().filter(|p| sound(p)) {
        low = low.min(*p);
        high = high.max(*p);
    }
    for f in reading.flowers.iter().filter(|f| sound(&f.centre)) {
        let r = f.disc.map_or(0.0, |d| if d.radius.is_finite() { d.radius.clamp(0.0, 1e6) } else { 0.0 });
        low = low.min(f.centre - r);
        high = high.max(f.centre + r);
    }
    if low.x > high.x {
        (low, high) = (DVec2::ZERO, DVec2::ONE);
    }
    let ground = reading.axes.iter().filter(standing).filter_map(foot).map(|p| p.y);
    let ground = ground.reduce(f64::min).unwrap_or(low.y);
    let tall = high.y - ground;
    // A pot stands on the ground, and the plant on its soil.
    let pots = reading.pots.iter().flat_map(|p| &p.lines).flatten().filter(|p| sound(p));
    let floor = pots.map(|p| p.y).fold(ground, f64::min);
    let origin_ink = DVec2::new(main.and_then(foot).map_or(0.5 * (low.x + high.x), |p| p.x), floor);
    // A plant that lies flat on the ground line has its breadth instead of a height.
    let extent = if tall > 1e-3 { tall } else { (high - low).max_element() };
    let extent = if extent > 1e-6 { extent } else { 1.0 };
    PlantMap { metres_per_ink: height_m(reading, spec) / extent, origin_ink }
}

/// Returns the height of the plant, metres: the requested one, else 8 m for a tree and 0.5 m for a herb.
fn height_m(reading: &Reading, spec: &SketchSpec) -> f64 {
    let usual = if reading.woody { 8.0 } else { 0.5 };
    spec.height_m.filter(|h| h.is_finite() && (1e-6..1e6).contains(h)).unwrap_or(usual)
}

fn add_axes(plant: &mut Plant, plans: &Plans, map: PlantMap) -> Vec<Option<AxisId>> {
    let mut ids: Vec<Option<AxisId>> = Vec::with_capacity(plans.rows.len());
    for plan in &plans.rows {
        let id = plan.as_ref().map(|plan| {
            let points: Vec<DVec3> = plan
                .points
                .iter()
                .map(|p| map.plant_at_depth(p.truncate(), p.z * map.metres_per_ink))
                .collect();
            let bearer = plan.bearer.and_then(|(row, node)| {
                let id = ids.get(row).copied().flatten()?;
                plant.axis(id).node_ids().nth(node)
            });
            plant.add_axis(plan.kind, bearer, plan.key, &points, plan.source)
        });
        ids.push(id);
    }
    ids
}

/// A drawn leaf that has a shape.
struct DrawnLeaf<'a> {
    leaf: &'a BladeReading,
    shape: ShapeId,
    local: LocalBlade,
    key: u64,
}

fn leaf_shapes<'a>(plant: &mut Plant, scene: &Scene<'_>, reading: &'a Reading) -> Vec<DrawnLeaf<'a>> {
    let mut of_stroke: LiteMap<Option<u32>, usize> = LiteMap::new();
    let mut leaves = Vec::with_capacity(reading.leaves.len());
    for leaf in &reading.leaves {
        let rank = of_stroke.entry(leaf.source).or_insert(0_usize);
        let key = blade_key(Part::Leaf, leaf, *rank, 0);
        *rank += 1;
        if let Some((shape, local)) = leaf_shape(plant, scene, leaf, key) {
            leaves.push(DrawnLeaf { leaf, shape, local, key });
        }
    }
    leaves
}

/// The crowns of a reading: organs drawn inside one hang at the front of its growth.
struct Crowned<'a>(Vec<Crown<'a>>);

struct Crown<'a> {
    outline: &'a [DVec2],
    low: DVec2,
    high: DVec2,
}

impl<'a> Crowned<'a> {
    fn new(reading: &'a Reading) -> Self {
        let crowns = reading.regions.iter().filter(|r| r.kind == RegionKind::Crown && r.outline.len() >= 3);
        Self(
            crowns
                .map(|r| Crown {
                    outline: &r.outline,
                    low: r.outline.iter().copied().fold(DVec2::INFINITY, DVec2::min),
                    high: r.outline.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max),
                })
                .collect(),
        )
    }

    fn holds(&self, p: DVec2) -> bool {
        let boxed = |c: &Crown<'_>| p.cmpge(c.low).all() && p.cmple(c.high).all();
        p.is_finite() && self.0.iter().any(|c| boxed(c) && contains(c.outline, p))
    }
}

fn middle(outline: &[DVec2]) -> DVec2 {
    #[expect(clippy::cast_precision_loss, reason = "a count")]
    let n = outline.len().max(1) as f64;
    outline.iter().sum::<DVec2>() / n
}

/// Places organs that were drawn inside crowns: on the twig that comes nearest to the viewer there.
fn hang_in_crowns(
    plant: &mut Plant,
    scene: &Scene<'_>,
    reading: &Reading,
    crowned: &Crowned<'_>,
    leaves: &[DrawnLeaf<'_>],
) {
    if crowned.0.is_empty() {
        return;
    }
    // Organs that are hung here do not bear later ones.
    let grown = plant.nodes.position.clone();
    let nodes = Front::new(&grown);
    let front = |plant: &Plant, root: DVec2| -> Option<(Bearing, DVec3)> {
        let at = scene.map.plant_from_ink(root);
        // A distance aside counts twice as much as one towards the viewer: near twigs win over far ones in front.
        let node = nodes.nearest_to_viewer(at)?;
        let position = grown.get(node)?;
        let axis = plant.nodes.axis.get(node)?;
        let bearing = Bearing {
            node: NodeId::new(node),
            position: *position,
            drawn: scene.map.ink_from_plant(position.truncate()),
            along: DVec2::Y,
            half_width: 0.0,
            key: plant.axis(*axis).key,
        };
        let depth = position.z + 0.015 * scene.map.metres_per_ink;
        Some((bearing, at.extend(depth)))
    };
    for leaf in leaves.iter().filter(|l| crowned.holds(l.leaf.root)) {
        let seat = front(plant, leaf.leaf.root);
        place_leaf(plant, scene, leaf.leaf, (leaf.shape, &leaf.local), leaf.key, seat);
    }
    for (i, flower) in reading.flowers.iter().enumerate().filter(|(_, f)| crowned.holds(f.centre)) {
        let seat = front(plant, flower.centre);
        place_flower(plant, scene, i, flower, seat);
    }
    for (i, fruit) in reading.fruits.iter().enumerate() {
        let centre = middle(&fruit.outline);
        if crowned.holds(centre) {
            let seat = front(plant, centre);
            place_fruit(plant, scene, (fruit, 0.0), i, seat);
        }
    }
}

/// Returns the share of its drawn width that a trunk keeps at each node: it dissolves on its way through a crown, and
/// the drawing shows only the outside of a crown.
fn thinned_in_crowns(points: &[DVec3], reading: &Reading, map: PlantMap) -> Vec<f64> {
    let crowns: Vec<(Vec<DVec2>, f64)> = (reading.regions.iter())
        .filter(|r| r.kind == RegionKind::Crown && r.outline.len() >= 3)
        .map(|r| r.outline.iter().map(|&p| map.plant_from_ink(p)).collect::<Vec<DVec2>>())
        .map(|outline| {
            let top = outline.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
            (outline, top)
        })
        .collect();
    let mut entry: Option<(f64, f64)> = None;
    let share = |p: &DVec3| {
        if entry.is_none() {
            let crown = crowns.iter().find(|(outline, _)| contains(outline, p.truncate()));
            entry = crown.map(|&(_, top)| (p.y, top));
        }
        // A seventh is left at the crown's top.
        entry.map_or(1.0, |(from, top)| {
            1.0 - 0.86 * ((p.y - from) / (top - from).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
        })
    };
    points.iter().map(share).collect()
}

/// Returns the pipe model of this plant: base radii from sizes, and drawn half widths if there are any.
fn pipes(
    plant: &Plant,
    plans: &Plans,
    ids: &[Option<AxisId>],
    reading: &Reading,
    spec: &SketchSpec,
    map: PlantMap,
) -> PipeModel {
    let woody = reading.woody;
    let height = plant.nodes.position.iter().map(|p| p.y).fold(0.0, f64::max);
    // Trees: a fortieth of the height. Herbs: a ninetieth. An axis longer than the plant's height uses its own length.
    // A herb next to a tree stays one.
    let slender = |kind| if woody && kind != AxisKind::Stem { 1.0 / 40.0 } else { 1.0 / 90.0 };
    let mut ground = Vec::new();
    for (i, axis) in plant.axes.iter().enumerate().filter(|(_, a)| a.bearer.is_none()) {
        let id = AxisId::new(i);
        let length = geom::polyline_length3(plant.axis_points(id));
        let size = if axis.kind == AxisKind::Root {
            0.5 * length
        } else {
            length.max(0.5 * height.min(2.0 * length))
        };
        ground.push((id, size * slender(axis.kind)));
    }
    let mut drawn = Vec::new();
    for (plan, id) in plans.rows.iter().zip(ids) {
        if let (Some(plan), Some(id)) = (plan, id)
            && plan.half_width.len() == plan.points.len()
        {
            let inside = thinned_in_crowns(plant.axis_points(*id), reading, map);
            let radii = plan.half_width.iter().zip(inside);
            drawn.push((*id, radii.map(|(w, share)| w * share * map.metres_per_ink).collect()));
        }
    }
    let taper = Taper { s: spec.taper.s, alpha: spec.taper.alpha, m: spec.taper.m };
    PipeModel {
        exponent: spec.pipe_exponent.filter(|t| t.is_finite()).unwrap_or(if woody { 2.0 } else { 2.5 }),
        taper,
        min_radius_m: height * if woody { 1.2e-3 } else { 1e-3 },
        max_per_length: 0.08,
        ground,
        drawn,
    }
}
