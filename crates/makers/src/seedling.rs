//! Organs of a scanned plant -> a plant: stem and stalks as axes with radii, leaves as blades.

use std::sync::Arc;

use base::{Report, Run, Stopped};
use bloom::{Limb, OrganPoints};
use glam::DVec3;
use leaf::{ScanError, ScanLeaf, ScanSpec};
use mesh::{Model, TriMesh};
use plant::{AxisKind, NodeId, Plant, Shape};
use serde::Serialize;
use skin::CloudColours;

use crate::error::{LeafError, SeedlingError};
use crate::look::{LeafLook, LeafyPlant, add_leaf};
use crate::scanned::{colours_of, painted, sheet_of};

/// One organ as found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OrganFit {
    /// Its name among the organs of the scan.
    pub name: String,
    /// Length of the stem, or of the stalk of a leaf, millimetres; 0 for a leaf without one.
    pub axis_mm: f64,
    /// Mean radius of that axis.
    pub radius_mm: f64,
    /// Length of the blade, along its midrib; 0 for a stem.
    pub blade_mm: f64,
    /// Greatest width of the blade.
    pub width_mm: f64,
    /// One side of the blade, square millimetres.
    pub area_mm2: f64,
}

/// Step at which surfaces are sampled for comparison with the scan: a tenth of the resolution of a hand-held scanner.
const STEP_M: f64 = 0.000_25;

/// Makes a plant of the organs of a scan, each with its points, metres, +Y up; the one called `stem` bears the others.
///
/// Organs whose points have colours are painted with them. An organ of too few points for a blade becomes an axis, with
/// a warning. Cost: n log n.
///
/// # Errors
/// [`SeedlingError`].
pub fn build_seedling(
    name: &str,
    organs: &[OrganPoints],
    scan: &ScanSpec,
    look: &LeafLook<'_>,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<(LeafyPlant, Vec<OrganFit>), SeedlingError> {
    let mut leafy = LeafyPlant::named(name);
    let mut fits = Vec::new();
    let stem = organs.iter().find(|o| o.name == "stem");
    let mut bearers = Vec::new();
    if let Some(OrganPoints { name, points, colors }) = stem {
        let limb = bloom::stem(points, run)?;
        let colours = colours_of(points, colors, run);
        bearers = add_axis(&mut leafy.plant, (AxisKind::Stem, 0), None, &limb, colours.as_ref());
        fits.push(OrganFit { name: name.clone(), ..OrganFit::from_limb(&limb) });
    }
    for (organ, key) in organs.iter().filter(|o| stem.is_none_or(|s| s.name != o.name)).zip(1_u64..) {
        let OrganPoints { name, points, colors } = organ;
        run.cancel.check().map_err(|c| LeafError::from(Stopped::from(c)))?;
        // It sits where it is nearest to the stem.
        let trunk = stem.map(|s| s.points.as_slice()).unwrap_or_default();
        let joint = bloom::joint(points, trunk).unwrap_or_else(|| lowest(points));
        let nearest = |n: &&NodeId| leafy.plant.nodes.position[n.index()].distance(joint);
        let bearer = bearers.iter().min_by(|a, b| nearest(a).total_cmp(&nearest(b))).copied();
        let limb = bloom::stalk(points, joint, run)?;
        let foot = limb.line.last().copied().unwrap_or(joint);
        let scan = ScanSpec { base: Some(foot), ..*scan };
        // Single leaves give the same warnings: strays, a missing stalk.
        let found = leaf::fit_scan(&limb.beyond, &scan, run, &mut Report::default());
        let found = match found {
            Ok(found) => Some(found),
            Err(ScanError::Cancelled(c)) => return Err(LeafError::from(Stopped::from(c)).into()),
            Err(_) => {
                base::warn!(
                    report,
                    "organ-thin",
                    { organ = name.clone(), points = points.len() },
                    "{organ}: its {points} points show no blade: it is an axis"
                );
                None
            }
        };
        let colours = colours_of(points, colors, run);
        let mut grove = Grove { leafy: &mut leafy, colours, look: *look, run };
        fits.push(grove.add_organ((name, key), bearer, (limb, points, found))?);
    }
    Ok((leafy, fits))
}

/// Returns places on a model's surface, to compare a scan with it.
pub fn surface_places(model: &Model) -> Vec<DVec3> {
    let faces = model.parts.iter().map(|p| &p.mesh);
    let corners = |m: &TriMesh| m.triangles.iter().map(|t| t.map(|i| m.position(i))).collect::<Vec<_>>();
    bloom::surface_places(faces.flat_map(corners), STEP_M)
}

/// Plant under construction.
struct Grove<'a> {
    leafy: &'a mut LeafyPlant,
    /// Colours of the organ that is added.
    colours: Option<CloudColours>,
    look: LeafLook<'a>,
    run: &'a Run<'a>,
}

impl Grove<'_> {
    /// Adds a leaf: its stalk, and its blade if one was found.
    fn add_organ(
        &mut self,
        (name, key): (&str, u64),
        bearer: Option<NodeId>,
        (mut limb, points, found): (Limb, &[DVec3], Option<ScanLeaf>),
    ) -> Result<OrganFit, SeedlingError> {
        let LeafyPlant { plant, textures } = &mut *self.leafy;
        let at = bearer.map(|b| (plant.nodes.position[b.index()], plant.nodes.radius_m[b.index()]));
        match &found {
            Some(found) => {
                // The stalk leads to the blade. One that is too short to be seen is half as thick as its bearer.
                let radius = limb.radii.last().copied().or(at.map(|a| 0.5 * a.1)).unwrap_or(0.000_5);
                limb.line.push(found.grid[found.columns / 2]);
                limb.radii.push(0.5 * radius);
            }
            None => limb = bloom::stem(points, self.run)?,
        }
        if let Some((place, _)) = at {
            limb.line.insert(0, place);
            limb.radii.insert(0, limb.radii.first().copied().unwrap_or(0.000_5));
        }
        let mut fit = OrganFit { name: name.into(), ..OrganFit::from_limb(&limb) };
        let mut bearer = bearer;
        if limb.line.len() >= 2 {
            bearer = add_axis(plant, (AxisKind::Petiole, key), bearer, &limb, self.colours.as_ref())
                .last()
                .copied();
        }
        let Some(found) = found else { return Ok(fit) };
        let sheet = sheet_of(&found, self.colours.as_ref(), textures, self.run).map_err(LeafError::from)?;
        let n = found.columns;
        let mesh = TriMesh {
            positions: sheet.points.iter().map(|p| p.as_vec3().to_array()).collect(),
            triangles: sheet.triangles().map(|t| t.map(|k| u32::try_from(k).unwrap_or(u32::MAX))).collect(),
            ..TriMesh::default()
        };
        fit.blade_mm = 1e3 * geom::polyline_length3(&found.midrib());
        fit.width_mm = 1e3 * found.grid.chunks(n).map(geom::polyline_length3).fold(0.0, f64::max);
        fit.area_mm2 = 1e6 * mesh.area();
        let paint = painted(&sheet, &self.look);
        if let Some((sheet, frame)) = sheet.framed() {
            let shape = plant.add_shape(Shape::Sheet(Arc::new(sheet)));
            add_leaf(plant, shape, frame, bearer, paint, key);
        }
        Ok(fit)
    }
}

impl OrganFit {
    fn from_limb(limb: &Limb) -> Self {
        let count = limb.radii.len().max(1) as f64;
        Self {
            name: String::new(),
            axis_mm: 1e3 * geom::polyline_length3(&limb.line),
            radius_mm: 1e3 * limb.radii.iter().sum::<f64>() / count,
            blade_mm: 0.0,
            width_mm: 0.0,
            area_mm2: 0.0,
        }
    }
}

/// Adds an axis and returns its nodes, from the base on.
fn add_axis(
    plant: &mut Plant,
    (kind, key): (AxisKind, u64),
    bearer: Option<NodeId>,
    limb: &Limb,
    colours: Option<&CloudColours>,
) -> Vec<NodeId> {
    let first = plant.nodes.radius_m.len();
    let axis = plant.add_axis(kind, bearer, key, &limb.line, None);
    plant.nodes.radius_m[first..].copy_from_slice(&limb.radii);
    if let Some(colours) = colours {
        plant.axes[axis.index()].colors = colours.along(&limb.line, &limb.radii);
    }
    plant.axis(axis).node_ids().collect()
}

fn lowest(points: &[DVec3]) -> DVec3 {
    points.iter().copied().min_by(|a, b| a.y.total_cmp(&b.y)).unwrap_or_default()
}
