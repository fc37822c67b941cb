//! A plant as an assembly: wood that bends by joints, and leaves as copies that hang on them.
//!
//! `Plant -> mechanics::Mechanism -> joints; Model + Layout -> joints of each vertex, leaves by their organ`

use base::{Report, Run};
use formats::{Assembly, AssemblyJoint, BoundCopies, WindGroup};
use glam::DVec3;
use mechanics::{Body, MechanicsError, MechanicsSpec, Mechanism, WoodGroup, articulate};
use mesh::{AlphaMode, Copies, Model, Part};
use plant::{AxisId, OrganId, Plant};
use skin::{Layout, Owner};

/// Reason why a plant cannot be an assembly.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AssemblyError {
    /// It has more leaves than Unreal places.
    #[error(
        "the plant has {leaves} leaves that are copies, and an assembly at most {MOST_PLACES}: make it younger, or less dense"
    )]
    Leaves {
        /// Their number.
        leaves: usize,
    },
    /// Its leaves have holes.
    #[error("leaves on cards have holes, which an assembly cannot have: draw them by their outlines")]
    Holes,
    /// It is not sound, or beyond the budget.
    #[error(transparent)]
    Mechanics(#[from] MechanicsError),
}

/// Most leaves: Unreal places each of them.
const MOST_PLACES: usize = 50_000;
/// Most kinds of leaves; those of fewer leaves are part of the wood's meshes.
const MOST_KINDS: usize = 5;
/// Most hinges of the mechanism, two a joint: with the base and at most 24 fruits there are 120 joints.
const MOST_HINGES: u32 = 190;
/// Length over which wood passes from one joint to the next, in radii to either side.
const BLEND: f64 = 2.0;
/// Height below which a plant is ground cover, metres.
const LOW_M: f64 = 1.0;

/// Makes an assembly of a plant: at most 120 joints, those that [`articulate`] chooses by bending energy, and at most 5
/// kinds of leaves that are copies, each on the joint of the wood that bears it. `layout`: of this model, whose columns of
/// the wind are left out.
///
/// Guaranteed: the meshes at rest are the model's; the same bits on every platform. Not guaranteed: tints of single
/// leaves, of which each kind has the mean. A plant without stems has one joint. Cost: that of [`articulate`], and
/// linear in vertices.
///
/// # Errors
/// [`AssemblyError`].
pub fn assemble(
    (plant, model, layout): (&Plant, &Model, &Layout),
    run: &Run<'_>,
) -> Result<Assembly, AssemblyError> {
    let skeleton = Skeleton::new(plant, run)?;
    let masked = |part: &Part| model.material(part).alpha == AlphaMode::Mask;
    if model.parts.iter().any(masked) {
        return Err(AssemblyError::Holes);
    }
    let mut marked = model.clone();
    mark(&mut marked, (plant, layout), &skeleton);
    let (mut rest, mut copies) = skin::copies(plant, &marked, layout);
    let places: usize = copies.iter().map(|c| c.places.len()).sum();
    if places > MOST_PLACES {
        return Err(AssemblyError::Leaves { leaves: places });
    }
    copies.iter_mut().for_each(to_mean_size);
    base::sort_by(&mut copies, |a, b| b.places.len().cmp(&a.places.len()));
    let few = copies.split_off(copies.len().min(MOST_KINDS));
    rest.parts.extend(few.iter().map(Copies::flattened));
    let holds = rest.parts.iter().map(|part| part.mesh.colors.iter().map(read_mark).collect()).collect();
    tint(&mut rest, model);
    rest.parts.iter_mut().for_each(|part| part.mesh.colors.clear());
    let bound = |copies: Copies| {
        let joints = copies.places.iter().map(|place| read_mark(&place.color)[0].0).collect();
        BoundCopies { joints, copies }
    };
    let is_low = model.bounds().size().y < LOW_M;
    let copies = copies.into_iter().map(bound).collect();
    Ok(Assembly { joints: skeleton.joints(plant), model: rest, holds, copies, is_low })
}

/// Gives a leaf the mean size of its copies, so that they have scales around 1.
fn to_mean_size(copies: &mut Copies) {
    let mean = copies.places.iter().map(|p| p.scale).sum::<f64>() / copies.places.len().max(1) as f64;
    if mean > 0.0 && mean.is_finite() {
        #[expect(clippy::cast_possible_truncation, reason = "f64 in the model, f32 in the mesh, by design")]
        copies.mesh.positions.iter_mut().flatten().for_each(|x| *x = (f64::from(*x) * mean) as f32);
        copies.places.iter_mut().for_each(|p| p.scale /= mean);
    }
}

/// Writes the joints of each vertex into its colour, which [`skin::copies`] carries along.
fn mark(model: &mut Model, (plant, layout): (&Plant, &Layout), skeleton: &Skeleton) {
    for (part, owners) in model.parts.iter_mut().zip(layout.owners()) {
        let mesh = &mut part.mesh;
        let mut marks = vec![[0.0, 0.0, 1.0]; mesh.positions.len()];
        let mut first = 0_usize;
        for (owner, triangles) in owners {
            let last = (first + triangles as usize).min(mesh.triangles.len());
            for &corner in mesh.triangles[first..last].iter().flatten() {
                let row = corner as usize;
                let place = DVec3::from_array(mesh.positions[row].map(f64::from));
                marks[row] = match owner {
                    Owner::Organ(id) => [f32::from(skeleton.joint_of_organ(id)), 0.0, 1.0],
                    Owner::Axes(axes) => skeleton.mark_of_wood(plant, axes, place),
                };
            }
            first = last;
        }
        mesh.colors = marks;
        mesh.wind.clear();
        mesh.pivots.clear();
    }
}

/// Reads what [`mark`] wrote: two joints with their shares.
fn read_mark(mark: &[f32; 3]) -> [(u16, f32); 2] {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows of at most 120 joints")]
    let row = |x: f32| x as u16;
    [(row(mark[0]), mark[2]), (row(mark[1]), 1.0 - mark[2])]
}

/// Multiplies the colour of each material by the mean tint of what has it, as an assembly has no tints.
fn tint(rest: &mut Model, model: &Model) {
    for (row, material) in rest.materials.iter_mut().enumerate() {
        let users = model.parts.iter().filter(|part| part.material.index() == row);
        let (mut sum, mut count) = ([0.0_f64; 3], 0.0);
        for color in users.flat_map(|part| &part.mesh.colors) {
            sum.iter_mut().zip(color).for_each(|(s, c)| *s += f64::from(*c));
            count += 1.0;
        }
        if count > 0.0 {
            #[expect(clippy::cast_possible_truncation, reason = "a colour")]
            let mean = sum.map(|s| (s / count) as f32);
            material.base_color = [0, 1, 2].map(|k| material.base_color[k] * mean[k]);
        }
    }
}

/// The joints of a plant.
struct Skeleton {
    /// `None` for a plant without stems, which has one joint.
    mechanism: Option<Mechanism>,
    /// For each body, those that continue its axis.
    next: Vec<Vec<usize>>,
    /// Length to either side of the joint of each body over which wood passes to it, metres.
    reaches: Vec<f64>,
}

impl Skeleton {
    fn new(plant: &Plant, run: &Run<'_>) -> Result<Self, AssemblyError> {
        let group = WoodGroup::seen_in(plant);
        let spec = MechanicsSpec { group, most_joints: MOST_HINGES, ..MechanicsSpec::default() };
        let mechanism = match articulate(plant, &spec, run, &mut Report::default()) {
            Ok(mechanism) => mechanism,
            Err(error @ (MechanicsError::OverBudget(_) | MechanicsError::Unsound(_))) => {
                return Err(error.into());
            }
            Err(_) => return Ok(Self { mechanism: None, next: Vec::new(), reaches: Vec::new() }),
        };
        let bodies = &mechanism.bodies;
        let mut next = vec![Vec::new(); bodies.len()];
        for (row, body) in bodies.iter().enumerate() {
            if let Some(parent) = body.parent.filter(|&p| continues(body, (p, &bodies[p]))) {
                next[parent].push(row);
            }
        }
        let reaches = bodies.iter().map(|body| BLEND * radius_at(plant, body)).collect();
        Ok(Self { mechanism: Some(mechanism), next, reaches })
    }

    /// Returns the joints; the first stands on the ground.
    fn joints(&self, plant: &Plant) -> Vec<AssemblyJoint> {
        let Some(mechanism) = &self.mechanism else {
            let group = WindGroup::Trunk;
            return vec![AssemblyJoint { name: "base".to_owned(), parent: None, at: DVec3::ZERO, group }];
        };
        let joint = |body: &Body| {
            let order = body.axis.map(|axis| plant.axis(axis).order);
            let group = match order {
                None if body.stalk.is_none() => WindGroup::Trunk,
                Some(0) => WindGroup::Trunk,
                Some(1) => WindGroup::Limb,
                _ => WindGroup::Twig,
            };
            AssemblyJoint { name: body.name.clone(), parent: body.parent, at: body.origin, group }
        };
        mechanism.bodies.iter().map(joint).collect()
    }

    fn joint_of_organ(&self, organ: OrganId) -> u16 {
        self.mechanism.as_ref().map_or(0, |m| row(m.body_of_organ(organ)))
    }

    /// Returns the mark of a place on the surface of a tube along some axes.
    fn mark_of_wood(&self, plant: &Plant, axes: &[AxisId], place: DVec3) -> [f32; 3] {
        let Some(mechanism) = &self.mechanism else { return [0.0, 0.0, 1.0] };
        let off = |axis: AxisId| geom::nearest_on_polyline3(plant.axis_points(axis), place).0;
        let nearest = match axes {
            [] => return [0.0, 0.0, 1.0],
            [one] => *one,
            [first, others @ ..] => {
                let start = (off(*first), *first);
                others.iter().map(|&a| (off(a), a)).fold(start, |m, a| if a.0 < m.0 { a } else { m }).1
            }
        };
        let body = mechanism.body_on_axis(plant, nearest, place);
        let bodies = &mechanism.bodies;
        let own = &bodies[body];
        let mark = |child: usize, share: f64, on: usize, other: usize| {
            #[expect(clippy::cast_possible_truncation, reason = "a share")]
            let share = if on == child { share } else { 1.0 - share } as f32;
            [f32::from(row(on)), f32::from(row(other)), share]
        };
        // Before the joint at the foot of its own body, and before those of the bodies that go on.
        if let Some(parent) = own.parent.filter(|&p| continues(own, (p, &bodies[p])))
            && let Some(share) = self.share(own, self.reaches[body], place)
        {
            return mark(body, share, body, parent);
        }
        let shared = |&child: &usize| Some((child, self.share(&bodies[child], self.reaches[child], place)?));
        match self.next[body].iter().find_map(shared) {
            Some((child, share)) => mark(child, share, body, child),
            None => [f32::from(row(body)), 0.0, 1.0],
        }
    }

    /// Returns the share that a body has of a place near its joint; `None` farther away.
    fn share(&self, body: &Body, reach: f64, place: DVec3) -> Option<f64> {
        let way = (body.centre - body.origin).try_normalize()?;
        let along = (place - body.origin).dot(way);
        (along.abs() < reach).then(|| 0.5 + 0.5 * along / reach)
    }
}

/// Returns whether a body goes on where its parent ends, along the same axis.
fn continues(body: &Body, (row, parent): (usize, &Body)) -> bool {
    body.axis.is_some() && (parent.axis == body.axis || row == 0)
}

/// Returns the radius of wood at the joint of a body.
fn radius_at(plant: &Plant, body: &Body) -> f64 {
    let Some(axis) = body.axis else { return 0.0 };
    let rows = plant.axis_points(axis).iter().zip(plant.axis_radii(axis));
    let near =
        rows.min_by(|a, b| a.0.distance_squared(body.origin).total_cmp(&b.0.distance_squared(body.origin)));
    near.map_or(0.0, |(_, radius)| *radius)
}

/// Narrows the row of a body: there are at most 120.
fn row(body: usize) -> u16 {
    u16::try_from(body).unwrap_or(0)
}
