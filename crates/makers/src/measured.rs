//! One measured leaf: marks or chief veins -> a plant.

use base::{Counted, Report, Run, Seed};
use leaf::{FullMarks, Leaf, RayLeaf, Rays};
use plant::{Paint, VeinShade};
use skin::LeafColours;

use crate::error::LeafError;
use crate::look::{COARSER, LeafLook, LeafyPlant, bear};

/// Widths of the pale band along chief veins.
struct Band {
    /// Visible width, as a share of the leaf's length: a fiftieth.
    of_length: f64,
    /// Largest width, as a share of the distance between two chief veins.
    of_gap: f64,
    /// Least width, metres.
    least_m: f64,
}

const BAND: Band = Band { of_length: 0.02, of_gap: 0.3, least_m: 1e-9 };

/// Makes a plant of one leaf from complete marks (Wang et al. 2011). Returns its surface and the marks as they are
/// meshed, too.
///
/// # Errors
/// [`LeafError`].
pub fn build_leaf(
    name: &str,
    marks: &FullMarks,
    look: &LeafLook<'_>,
    seed: Seed,
    run: &Run<'_>,
    report: &mut Report,
) -> Result<(LeafyPlant, Leaf, FullMarks), LeafError> {
    run.budget.check(Counted::Triangles, look.mesh().triangles(marks.rows.len()), COARSER)?;
    let marks = look.spec.shaped(marks)?;
    let leaf = report.stage("structure", run.clock, |_| Leaf::new(&marks, look.spec))?;
    run.cancel.check()?;
    let mut made = LeafyPlant::named(name);
    made.textures.push(report.stage("mesh", run.clock, |_| look.texture(&leaf, seed, run)));
    bear(&mut made.plant, leaf.blade(), None, look.paint([1.0; 3]), seed.number());
    Ok((made, leaf, marks))
}

/// A leaf of chief veins as it was made.
#[derive(Clone, Debug)]
pub struct RayLeafParts {
    /// The plant of this one leaf.
    pub leafy: LeafyPlant,
    /// Its surface and its veins.
    pub leaf: RayLeaf,
    /// The chief veins as they are meshed.
    pub rays: Rays,
}

/// Makes a plant of one leaf whose chief veins have a common start, with `side_veins` on either side of a chief vein in
/// each lobe.
///
/// The blade's colour is on its vertices, by the distance from the nearest vein.
///
/// # Errors
/// [`LeafError::Rays`], [`LeafError::Cancelled`], [`LeafError::OverBudget`].
pub fn build_ray_leaf(
    name: &str,
    rays: &Rays,
    (look, side_veins): (&LeafLook<'_>, u32),
    run: &Run<'_>,
    report: &mut Report,
) -> Result<RayLeafParts, LeafError> {
    let rays = look.spec.shaped_rays(rays)?;
    let leaf = report.stage("structure", run.clock, |_| {
        RayLeaf::new(&rays, look.spec.thickness.unwrap_or_default()).map(|mut leaf| {
            leaf.add_side_veins(&rays, side_veins as usize);
            leaf
        })
    })?;
    run.cancel.check()?;
    let colours = LeafColours::default().wilted(look.spec.wilt);
    let [blade, vein] = [colours.blade, colours.vein].map(base::linear_color);
    let shade = VeinShade { vein, blade, reach_m: band_m(&leaf, &rays) };
    let spans = leaf.veins.iter().chain(&leaf.sides).map(|v| v.marks.len().saturating_sub(1)).sum::<usize>();
    let (steps, sides) = (u64::from(look.spec.subdivisions), u64::from(look.spec.sides));
    let squares = (leaf.blade.columns_at().len() * leaf.blade.rows_at().len()) as u64;
    let triangles = 2 * (spans as u64 * steps * sides + squares * steps * steps);
    run.budget.check(Counted::Triangles, triangles, "lower subdivisions, sides or side-veins")?;
    let mut leafy = LeafyPlant::named(name);
    bear(&mut leafy.plant, leaf.blade(shade), None, Paint::Tinted([1.0; 3]), 1);
    Ok(RayLeafParts { leafy, leaf, rays })
}

/// Returns the width of the pale band along a chief vein: less where veins are close together.
fn band_m(leaf: &RayLeaf, rays: &Rays) -> f64 {
    let apart = leaf.veins.windows(2).map(|w| {
        let middle = |v: &plant::Vein| v.curve.ball(0.5).centre;
        middle(&w[0]).distance(middle(&w[1]))
    });
    let widest = BAND.of_length * rays.length();
    apart.fold(widest, |reach, d| reach.min(BAND.of_gap * d)).max(BAND.least_m)
}
