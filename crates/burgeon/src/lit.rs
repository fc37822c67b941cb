//! Light on plants: the light that each organ and axis of a stand absorbs, in a table, as figures and as colours.
//!
//! `plants with their models -> LitScene -> absorb -> LitStand { organs, figures } -> CSV | coloured model`

use std::io;

use base::{Bound, Budget, Check, Report, Run, Seed, Severity, ops};
use formats::AddedColumn;
use glam::DVec3;
use light::{
    Absorption, Beams, EnergyBalance, LightError, LightSpec, LitScene, Optics, ReceiverLight, absorb,
};
use mesh::{AlphaMode, Material, MaterialId, MaterialKind, Model, Standing};
use scan::Stood;
use serde::Serialize;
use skin::{NOTHING, PARTS, part_is_of_axis, part_of_axis, part_of_organ, triangle_labels};

/// Unit of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum LightUnit {
    /// Watts, at one moment.
    #[serde(rename = "W")]
    Watt,
    /// Megajoules, for a day.
    #[serde(rename = "MJ")]
    Megajoule,
}

impl LightUnit {
    /// Returns the unit as people read it.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Watt => "W",
            Self::Megajoule => "MJ",
        }
    }

    /// Returns the unit in names of columns.
    const fn column(self) -> &'static str {
        match self {
            Self::Watt => "w",
            Self::Megajoule => "mj",
        }
    }
}

/// Light on a stand: its sources, and the settings for following it.
#[derive(Clone, Debug, PartialEq)]
pub struct LightOptions {
    /// Sky and sun.
    pub beams: Beams,
    /// Unit of the beams.
    pub unit: LightUnit,
    /// Settings for following the light. `ground_m` is the height of the ground; leaves that hang below lower it.
    pub spec: LightSpec,
    /// Optics of leaves, petals and sepals.
    pub leaf: Optics,
    /// Optics of all other parts.
    pub wood: Optics,
}

impl LightOptions {
    /// Makes options with the optics of the field's tables.
    pub fn new(beams: Beams) -> Self {
        Self {
            beams,
            unit: LightUnit::Watt,
            spec: LightSpec::default(),
            leaf: Optics::LEAF,
            wood: Optics::WOOD,
        }
    }
}

/// Light on an organ or an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LitOrgan {
    /// Place of its plant in the stand, from 0.
    pub plant: u32,
    /// Row of [`PARTS`].
    pub part: u8,
    /// Row of the plant's organs, or of its axes.
    pub row: i32,
    /// Row of its axis, or of the axis that bears it; [`NOTHING`] for none.
    pub axis: i32,
    /// Branching order of that axis.
    pub order: u32,
    /// Light that falls on it.
    pub light: ReceiverLight,
}

/// Figures of a stand in light. Figures that do not apply or were not measured are none.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LightFigures {
    /// Unit of the light.
    pub unit: LightUnit,
    /// Light on a square metre of a horizontal surface above the stand.
    pub incoming_per_m2: f64,
    /// Light absorbed by all organs and axes.
    pub absorbed: f64,
    /// Light absorbed by leaves.
    pub leaf_absorbed: f64,
    /// Light absorbed by leaves for each square metre of one side, over that on a horizontal surface above the stand.
    pub leaf_share: Option<f64>,
    /// The share of the light above the ground of a cell that plants absorb; for stands that repeat themselves.
    pub fapar: Option<f64>,
    /// The share of the light that meets a plant on its way to the ground; for stands that repeat themselves.
    pub intercepted: Option<f64>,
    /// One side of all leaves, square metres.
    pub leaf_area_m2: f64,
    /// Leaf area over ground, for a cell that repeats itself.
    pub leaf_area_index: Option<f64>,
    /// The k of Beer's law, 1 - intercepted = exp(-k LAI); for stands that repeat themselves.
    pub extinction: Option<f64>,
    /// The share of leaf area that is in the sun; with a sun only.
    pub sunlit: Option<f64>,
    /// Energy balance of a cell.
    pub balance: Option<EnergyFigures>,
    /// Number of directions in which light was followed.
    pub directions: u64,
    /// Triangles.
    pub triangles: u64,
}

/// [`EnergyBalance`] for reports.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct EnergyFigures {
    incoming: f64,
    plants: f64,
    soil: f64,
    reflected: f64,
    lost: f64,
}

impl From<EnergyBalance> for EnergyFigures {
    fn from(b: EnergyBalance) -> Self {
        Self {
            incoming: b.incoming_w,
            plants: b.absorbed_w,
            soil: b.soil_w,
            reflected: b.reflected_w,
            lost: b.lost_w,
        }
    }
}

/// A stand in light.
#[derive(Clone, Debug)]
pub struct LitStand {
    /// Axes, then organs, of one plant after the other; only those that have a surface.
    pub organs: Vec<LitOrgan>,
    /// Figures of all of them.
    pub figures: LightFigures,
    /// Light on patches and in directions.
    pub absorption: Absorption,
}

/// Owner of a receiver of the scene.
#[derive(Clone, Copy)]
struct Owner {
    plant: u32,
    part: u8,
    row: i32,
    axis: i32,
    order: u32,
}

/// Least lines of light that cross a leaf without its figures being rough: a hundred are off by a tenth by chance.
const LINES_FEWEST: u64 = 100;

/// Largest share of leaf area with rough figures.
const ROUGH_MOST: f64 = 0.05;

/// Largest leaf area index: the densest stands that were measured have 18 (Asner, Scurlock and Hicke 2003).
const LEAF_AREA_INDEX_MOST: f64 = 20.0;

/// Range of the area of meshes of leaves over that of the leaves: needles and scales that are drawn as sheets have less
/// or more.
const LEAF_MESH: [f64; 2] = [0.7, 1.4];

/// Computes the light that each organ and axis of a stand absorbs.
///
/// Plants shade one another. The meshes receive the light: holes of textures are ignored. Checks of the result go into
/// the report.
/// Guaranteed: the same bits for any executor. Cost: as [`absorb`].
///
/// # Errors
/// [`LightError`].
pub fn light_stand(
    stand: &[Stood<'_>],
    options: &LightOptions,
    (seed, run): (Seed, &Run<'_>),
    report: &mut Report,
) -> Result<LitStand, LightError> {
    let (scene, owners) = scene_of(stand, options, &run.budget)?;
    let lowest =
        scene.triangles.iter().zip(&scene.owners).filter(|(_, o)| is_leaf(owners[**o as usize].part));
    let lowest = lowest.flat_map(|(t, _)| t.iter()).map(|i| scene.points[*i as usize].y);
    let ground_m = lowest.fold(options.spec.ground_m, f64::min);
    let spec = LightSpec { ground_m, ..options.spec };
    let absorption = absorb(&scene, &options.beams, &spec, seed, run)?;
    let rows = owners.iter().zip(&absorption.receivers).filter(|(_, light)| light.area_m2 > 0.0);
    let organs: Vec<LitOrgan> = rows
        .map(|(o, light)| LitOrgan {
            plant: o.plant,
            part: o.part,
            row: o.row,
            axis: o.axis,
            order: o.order,
            light: *light,
        })
        .collect();
    let figures = figures_of(&organs, &absorption, options, scene.triangles.len());
    check(&organs, &figures, stand, report);
    Ok(LitStand { organs, figures, absorption })
}

/// Whether a row of [`PARTS`] counts as leaf.
fn is_leaf(part: u8) -> bool {
    part == part_of_organ(plant::OrganKind::Leaf)
}

/// Whether light passes through a row of [`PARTS`]: leaves, petals and sepals.
fn is_thin(part: u8) -> bool {
    use plant::OrganKind::{Petal, Sepal};
    is_leaf(part) || [Petal, Sepal].into_iter().any(|kind| part == part_of_organ(kind))
}

/// Returns the receivers of a plant: its axes, its organs, and parts that are neither.
fn owners_of(plant: u32, stood: &Stood<'_>) -> impl Iterator<Item = Owner> {
    let row = |k: usize| i32::try_from(k).unwrap_or(i32::MAX);
    let axes = stood.plant.axes.iter().enumerate();
    let axes = axes.map(move |(k, a)| Owner {
        plant,
        part: part_of_axis(a.kind),
        row: row(k),
        axis: row(k),
        order: a.order,
    });
    let organs = stood.plant.organs.iter().enumerate().map(move |(k, o)| {
        let axis = o.bearer.and_then(|n| stood.plant.nodes.axis.get(n.index()));
        let order = axis.and_then(|a| stood.plant.axes.get(a.index())).map_or(0, |a| a.order);
        let axis = axis.map_or(NOTHING, |a| row(a.index()));
        Owner { plant, part: part_of_organ(o.kind), row: row(k), axis, order }
    });
    let body = part_of_organ(plant::OrganKind::Body);
    axes.chain(organs).chain([Owner { plant, part: body, row: NOTHING, axis: NOTHING, order: 0 }])
}

/// Returns all triangles of a stand in place, in the order of plants, parts and rows.
fn scene_of(
    stand: &[Stood<'_>],
    options: &LightOptions,
    budget: &Budget,
) -> Result<(LitScene, Vec<Owner>), LightError> {
    let triangles: usize = stand.iter().map(|s| s.standing.model.triangle_count()).sum();
    budget.check(base::Counted::Triangles, triangles as u64, "choose fewer or coarser plants")?;
    let (mut scene, mut owners) = (LitScene::default(), Vec::new());
    for (number, stood) in (0_u32..).zip(stand) {
        let first = owners.len();
        owners.extend(owners_of(number, stood));
        let axes = stood.plant.axes.len();
        let labels = triangle_labels(stood.plant, stood.standing.model, stood.layout);
        let Standing { position, turn, scale, .. } = stood.standing;
        for (part, labels) in stood.standing.model.parts.iter().zip(labels) {
            let base = u32::try_from(scene.points.len()).unwrap_or(u32::MAX);
            let placed = |p: &[f32; 3]| turn * (DVec3::from_array(p.map(f64::from)) * scale) + position;
            scene.points.extend(part.mesh.positions.iter().map(placed));
            for (corners, [_, axis, organ]) in part.mesh.triangles.iter().zip(labels) {
                let row = match (usize::try_from(organ), usize::try_from(axis)) {
                    (Ok(organ), _) => axes + organ,
                    (_, Ok(axis)) => axis,
                    _ => axes + stood.plant.organs.len(),
                };
                scene.triangles.push(corners.map(|i| base.saturating_add(i)));
                scene.owners.push(u32::try_from(first + row).unwrap_or(u32::MAX));
            }
        }
    }
    let optics = |o: &Owner| if is_thin(o.part) { options.leaf } else { options.wood };
    scene.receivers = owners.iter().map(optics).collect();
    Ok((scene, owners))
}

fn figures_of(
    organs: &[LitOrgan],
    absorption: &Absorption,
    options: &LightOptions,
    triangles: usize,
) -> LightFigures {
    let leaves = || organs.iter().filter(|o| is_leaf(o.part)).map(|o| &o.light);
    let leaf_area_m2: f64 = leaves().map(|l| l.area_m2).sum();
    let leaf_absorbed: f64 = leaves().map(|l| l.absorbed_w).sum();
    let absorbed: f64 = organs.iter().map(|o| o.light.absorbed_w).sum();
    // Leaves that are seen only edge-on show no area.
    let lit = leaves().filter_map(|l| Some((l.area_m2, l.sunlit?)));
    let [in_sun, seen] = lit.fold([0.0; 2], |[lit, all], (area, share)| [lit + area * share, all + area]);
    let cell = options.spec.repeat_m.map(|[width, depth]| width * depth);
    let incoming = cell.map(|cell| cell * absorption.horizontal);
    let leaf_area_index = cell.map(|cell| leaf_area_m2 / cell);
    let intercepted = incoming.map(|incoming| absorption.intercepted_w / incoming);
    let extinction = intercepted.zip(leaf_area_index).filter(|(share, lai)| *share < 1.0 && *lai > 0.0);
    LightFigures {
        unit: options.unit,
        incoming_per_m2: absorption.horizontal,
        absorbed,
        leaf_absorbed,
        leaf_share: (leaf_area_m2 > 0.0).then(|| leaf_absorbed / (leaf_area_m2 * absorption.horizontal)),
        fapar: incoming.map(|incoming| absorbed / incoming),
        intercepted,
        leaf_area_m2,
        leaf_area_index,
        extinction: extinction.map(|(share, lai)| -ops::ln(1.0 - share) / lai),
        sunlit: (seen > 0.0).then(|| in_sun / seen),
        balance: absorption.balance.map(EnergyFigures::from),
        directions: absorption.directions.len() as u64,
        triangles: triangles as u64,
    }
}

/// Names of the checks of light, in the order in which they are made.
pub(crate) const LIGHT_CHECKS: [&str; 5] =
    ["light-dark", "light-no-leaves", "light-rough", "light-leaf-meshes", "light-dense"];

fn check(organs: &[LitOrgan], figures: &LightFigures, stand: &[Stood<'_>], report: &mut Report) {
    let share = |x: f64| format!("{:.1} %", 100.0 * x);
    let mut test = |name, value: f64, bound: Bound, shown: [String; 2], message: String, advice| {
        debug_assert!(LIGHT_CHECKS.contains(&name), "{name} is listed");
        let severity = if name == "light-dark" { Severity::Error } else { Severity::Warning };
        report.check(Check { name, value, bound, shown, severity, message, advice });
    };
    test(
        "light-dark",
        figures.absorbed,
        Bound::AtLeast(f64::MIN_POSITIVE),
        [figures.absorbed.to_string(), "more than 0".into()],
        format!("the plant absorbs {} {}", figures.absorbed, figures.unit.word()),
        "all of it is below the ground, or throws all light back",
    );
    let leaves = || organs.iter().filter(|o| is_leaf(o.part));
    let count = leaves().count();
    test(
        "light-no-leaves",
        count as f64,
        Bound::AtLeast(1.0),
        [count.to_string(), "1".into()],
        format!("the plant has {count} leaves in light"),
        "figures of leaves are missing; the table has its wood and flowers",
    );
    if count == 0 {
        return;
    }
    let rough: f64 = leaves().filter(|o| o.light.crossings < LINES_FEWEST).map(|o| o.light.area_m2).sum();
    let rough = rough / figures.leaf_area_m2;
    test(
        "light-rough",
        rough,
        Bound::AtMost(ROUGH_MOST),
        [share(rough), share(ROUGH_MOST)],
        format!(
            "{} of the leaf area are leaves that fewer than {LINES_FEWEST} lines of light cross",
            share(rough)
        ),
        "sums are sound, but figures of single leaves are rough: give more lines of light",
    );
    let measured: f64 =
        stand.iter().map(|s| s.plant.measure().leaf_area_m2 * s.standing.scale * s.standing.scale).sum();
    if measured > 0.0 {
        let of_mesh = figures.leaf_area_m2 / measured;
        let beyond = (of_mesh / LEAF_MESH[1]).max(LEAF_MESH[0] / of_mesh);
        test(
            "light-leaf-meshes",
            beyond,
            Bound::AtMost(1.0),
            [share(of_mesh), format!("{} to {}", share(LEAF_MESH[0]), share(LEAF_MESH[1]))],
            format!("the meshes of the leaves have {} of the measured leaf area", share(of_mesh)),
            "light is that of the meshes: needles, scales and thick leaves are not drawn one by one as sheets",
        );
    }
    if let Some(lai) = figures.leaf_area_index {
        test(
            "light-dense",
            lai,
            Bound::AtMost(LEAF_AREA_INDEX_MOST),
            [format!("{lai:.1}"), format!("{LEAF_AREA_INDEX_MOST}")],
            format!("the stand has a leaf area index of {lai:.1}"),
            "no stand is so dense: repeat it in larger cells",
        );
    }
}

/// Colours of the scale at even shares of the light: dark violet, purple, red, orange, pale yellow; sRGB.
pub const LIGHT_SCALE: [[f64; 3]; 6] = [
    [0.05, 0.03, 0.20],
    [0.30, 0.07, 0.48],
    [0.60, 0.16, 0.45],
    [0.87, 0.32, 0.25],
    [0.98, 0.60, 0.10],
    [0.99, 0.95, 0.60],
];

/// Columns of light in files of structure.
const LIGHT_COLUMNS: [&str; 4] = ["IncidentPAR", "AbsorbedPAR", "fAPAR", "Sunlit"];

/// Share of patches that may be brighter than the end of the scale.
const BRIGHTER: f64 = 0.02;

impl LitStand {
    /// Writes a row for each axis and organ.
    ///
    /// | column | meaning |
    /// |---|---|
    /// | `plant` | its number, from 1 |
    /// | `kind` | a word of [`PARTS`] |
    /// | `id` | row of the plant's organs or, of an axis, of its axes, from 0 |
    /// | `axis`, `order` | the axis that it is or that bears it (empty for none), and its branching order |
    /// | `area_m2`, `height_m` | of one side of its mesh; of its middle |
    /// | `incident_w_m2`, `absorbed_w_m2` | on both sides, for each square metre of one side; `mj` for `w` of a day |
    /// | `absorbed_w` | all of it |
    /// | `fapar` | `absorbed_w_m2` over the light on a horizontal surface above the plants |
    /// | `sunlit` | the share of its area that is in the sun; empty without a sun |
    /// | `lines` | number of lines of light that cross it |
    ///
    /// # Errors
    /// The error of the writer.
    pub fn write_csv(&self, out: &mut dyn io::Write) -> io::Result<()> {
        let unit = self.figures.unit.column();
        writeln!(
            out,
            "plant,kind,id,axis,order,area_m2,height_m,incident_{unit}_m2,absorbed_{unit}_m2,absorbed_{unit},fapar,sunlit,lines"
        )?;
        for o in &self.organs {
            let light = &o.light;
            let per_area = |w: f64| w / light.area_m2;
            let kind = PARTS.get(usize::from(o.part)).copied().unwrap_or_default();
            let known = |row: i32| if row == NOTHING { String::new() } else { row.to_string() };
            let absorbed = per_area(light.absorbed_w);
            writeln!(
                out,
                "{},{kind},{},{},{},{},{},{},{},{},{},{},{}",
                o.plant + 1,
                known(o.row),
                known(o.axis),
                o.order,
                light.area_m2,
                light.height_m,
                per_area(light.incident_w),
                absorbed,
                light.absorbed_w,
                absorbed / self.figures.incoming_per_m2,
                light.sunlit.map_or_else(String::new, |s| s.to_string()),
                light.crossings
            )?;
        }
        Ok(())
    }

    /// Returns light as columns of a plant's axes and organs, for files of its structure: `IncidentPAR` and
    /// `AbsorbedPAR` (for each square metre of one side, in the unit of the figures), `fAPAR` and `Sunlit`. `number`:
    /// of the plant in the stand, from 0.
    pub fn columns(&self, number: u32, plant: &plant::Plant) -> Vec<AddedColumn> {
        let empty = |name: &str| AddedColumn {
            name: name.into(),
            axes: vec![None; plant.axes.len()],
            organs: vec![None; plant.organs.len()],
        };
        let mut columns: Vec<AddedColumn> = LIGHT_COLUMNS.iter().map(|name| empty(name)).collect();
        for organ in self.organs.iter().filter(|o| o.plant == number) {
            let Ok(row) = usize::try_from(organ.row) else { continue };
            for (column, value) in columns.iter_mut().zip(self.cells(organ)) {
                let rows = if part_is_of_axis(organ.part) { &mut column.axes } else { &mut column.organs };
                if let Some(cell) = rows.get_mut(row) {
                    *cell = value;
                }
            }
        }
        columns
    }

    /// Returns the values of [`LIGHT_COLUMNS`] for an organ.
    fn cells(&self, organ: &LitOrgan) -> [Option<f64>; LIGHT_COLUMNS.len()] {
        let light = &organ.light;
        let [incident, absorbed] = [light.incident_w, light.absorbed_w].map(|w| w / light.area_m2);
        [Some(incident), Some(absorbed), Some(absorbed / self.figures.incoming_per_m2), light.sunlit]
    }

    /// Returns the light at the end of the scale of colours, for each square metre: all patches but the brightest 2 %.
    pub fn brightest(&self) -> f64 {
        let patches = self.absorption.patches.iter().filter(|p| p.area_m2 > 0.0);
        let mut values: Vec<f64> = patches.map(|p| p.absorbed_w / p.area_m2).collect();
        base::sort_numbers(&mut values);
        let last = values.len().saturating_sub(1) as f64;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a row")]
        let row = (last * (1.0 - BRIGHTER)) as usize;
        values.get(row).copied().unwrap_or_default().max(f64::MIN_POSITIVE)
    }

    /// Returns the stand as one model, coloured by the light that each patch absorbs for its area: from dark violet for
    /// nothing over red to pale yellow at [`Self::brightest`]. `stand`: the one that was lit.
    pub fn heat_map(&self, name: &str, stand: &[Stood<'_>]) -> Model {
        let standing: Vec<Standing<'_>> = stand.iter().map(|s| s.standing).collect();
        let mut model = crate::scene_model(name, &standing);
        let brightest = self.brightest();
        let mut patches = self.absorption.patch_of_triangle.iter();
        for part in &mut model.parts {
            part.material = MaterialId::new(0);
            let mesh = &mut part.mesh;
            mesh.uvs = Vec::new();
            mesh.colors = vec![[0.0; 3]; mesh.positions.len()];
            for (corners, patch) in mesh.triangles.iter().zip(&mut patches) {
                let patch = self.absorption.patches.get(*patch as usize).copied().unwrap_or_default();
                let value = if patch.area_m2 > 0.0 { patch.absorbed_w / patch.area_m2 } else { 0.0 };
                let colour = colour_of(value / brightest);
                corners.iter().for_each(|i| mesh.colors[*i as usize] = colour);
            }
        }
        let plain = Material::plain("light", MaterialKind::Other, [1.0; 3]);
        model.materials =
            vec![Material { double_sided: true, alpha: AlphaMode::Opaque, roughness: 1.0, ..plain }];
        model
    }
}

/// Returns a colour of the scale in linear light; `share` is limited to 0 to 1.
fn colour_of(share: f64) -> [f32; 3] {
    let at = share.clamp(0.0, 1.0) * (LIGHT_SCALE.len() - 1) as f64;
    let low = (ops::whole(at) as usize).min(LIGHT_SCALE.len() - 2);
    let [from, to] = [LIGHT_SCALE[low], LIGHT_SCALE[low + 1]];
    #[expect(clippy::cast_possible_truncation, reason = "a colour")]
    let mix = |k: usize| base::linear_of_srgb(ops::lerp(from[k], to[k], at - low as f64)) as f32;
    [0, 1, 2].map(mix)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{TreeEvaluator, TreeOptions, TreeSpec};
    use light::SkyKind;

    fn tree() -> TreeEvaluator {
        let mut evaluator = TreeEvaluator::default();
        let made =
            evaluator.update(&TreeSpec::default(), Seed::new(3), &TreeOptions::default(), &Run::plain());
        made.expect("a tree");
        evaluator
    }

    fn stood(tree: &TreeEvaluator) -> Stood<'_> {
        Stood {
            standing: Standing::home("a tree", tree.model().expect("a model")),
            plant: tree.plant().expect("a plant"),
            layout: tree.layout().expect("a layout"),
        }
    }

    #[test]
    fn organs_absorb_what_the_stand_absorbs_and_upper_leaves_get_more() {
        let tree = tree();
        let mut options = LightOptions::new(Beams::sky(SkyKind::Overcast, 100.0).expect("a sky"));
        options.spec.repeat_m = Some([2.0, 2.0]);
        options.spec.lines = 20_000;
        let mut report = Report::default();
        let lit = light_stand(&[stood(&tree)], &options, (Seed::new(1), &Run::plain()), &mut report);
        let lit = lit.expect("light");
        let balance = lit.absorption.balance.expect("a balance");
        let sum: f64 = lit.organs.iter().map(|o| o.light.absorbed_w).sum();
        assert!((sum / balance.absorbed_w - 1.0).abs() < 1e-9);
        let kept = balance.absorbed_w + balance.soil_w + balance.reflected_w + balance.lost_w;
        assert!((kept / balance.incoming_w - 1.0).abs() < 1e-3, "{balance:?}");
        let mut leaves: Vec<&LitOrgan> = lit.organs.iter().filter(|o| is_leaf(o.part)).collect();
        base::sort_by(&mut leaves, |a, b| a.light.height_m.total_cmp(&b.light.height_m));
        let per_area = |of: &[&LitOrgan]| {
            let sum = |f: fn(&ReceiverLight) -> f64| of.iter().map(|o| f(&o.light)).sum::<f64>();
            sum(|l| l.absorbed_w) / sum(|l| l.area_m2)
        };
        let quarter = leaves.len() / 4;
        let (low, high) = (per_area(&leaves[..quarter]), per_area(&leaves[3 * quarter..]));
        assert!(quarter > 20 && high > 1.2 * low, "{high} above, {low} below");
        let model = lit.heat_map("light", &[stood(&tree)]);
        assert_eq!(model.validate().count(), 0);
        let mut csv = Vec::new();
        lit.write_csv(&mut csv).expect("a vector takes all");
        let csv = String::from_utf8(csv).expect("text");
        assert_eq!(csv.lines().count(), 1 + lit.organs.len());
        assert!(csv.lines().all(|l| l.split(',').count() == 13));
    }

    #[test]
    fn the_scale_ends_in_its_first_and_last_colour() {
        let ends = [colour_of(-1.0), colour_of(f64::NAN.max(2.0))];
        for (end, wanted) in ends.iter().zip([LIGHT_SCALE[0], LIGHT_SCALE[5]]) {
            for (found, srgb) in end.iter().zip(wanted) {
                assert!((f64::from(*found) - base::linear_of_srgb(srgb)).abs() < 1e-6);
            }
        }
    }
}
