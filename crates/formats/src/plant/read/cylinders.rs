//! Cylinders that hang on one another -> joints.

use glam::DVec3;
use plant::AxisKind;

use super::joints::{Joint, Link};
use super::{Fault, fault_at};

/// A piece of wood, or an internode.
#[derive(Clone, Debug)]
pub(super) struct Cylinder {
    /// Both ends, metres, +Y up.
    pub(super) ends: [DVec3; 2],
    /// Mean radius, metres; not a number if unknown.
    pub(super) radius: f64,
    /// Radii at both ends, if they are known.
    pub(super) end_radii: Option<[f64; 2]>,
    pub(super) parent: Option<usize>,
    pub(super) link: Link,
    pub(super) kind: AxisKind,
    pub(super) line: usize,
}

/// A child nearer to an end of a cylinder than this share of its length hangs on that end.
const SNAP: f64 = 0.02;
/// A child that begins farther from its place on the bearer than this factor of the bearer's radius leaves a gap;
/// others begin on the bearer's surface or in it.
const GAP: f64 = 2.0;

/// A child on a cylinder, and its place there as a share of the cylinder's length.
struct Hanging {
    share: f64,
    child: usize,
}

/// Returns the joints of cylinders, and the joint at which each cylinder ends.
///
/// # Errors
/// Parents that form a circle.
pub(super) fn joined(cylinders: &[Cylinder]) -> Result<(Vec<Joint>, Vec<usize>), Fault> {
    let mut hanging: Vec<Vec<Hanging>> = Vec::new();
    hanging.resize_with(cylinders.len(), Vec::new);
    for (child, c) in cylinders.iter().enumerate() {
        let Some(parent) = c.parent else { continue };
        let share = if c.link == Link::Follows { 1.0 } else { share_of(&cylinders[parent], c.ends[0]) };
        hanging[parent].push(Hanging { share, child });
    }
    let mut out =
        Joints { joints: Vec::new(), attach: vec![None; cylinders.len()], ends: vec![0; cylinders.len()] };
    let mut waiting: Vec<usize> =
        (0..cylinders.len()).rev().filter(|&k| cylinders[k].parent.is_none()).collect();
    let mut done = 0;
    while let Some(row) = waiting.pop() {
        done += 1;
        base::sort_by(&mut hanging[row], |a, b| a.share.total_cmp(&b.share));
        out.add(cylinders, row, &hanging[row]);
        waiting.extend(hanging[row].iter().map(|h| h.child));
    }
    if done == cylinders.len() {
        return Ok((out.joints, out.ends));
    }
    let mut is_done = vec![false; cylinders.len()];
    out.attach.iter().enumerate().for_each(|(k, a)| is_done[k] = a.is_some());
    let first = is_done.iter().position(|d| !d).unwrap_or(0);
    let advice = "a cylinder grows from what is below it: mend the column of parents";
    Err(fault_at(cylinders[first].line, "what it hangs on leads round in a circle", advice))
}

fn share_of(bearer: &Cylinder, at: DVec3) -> f64 {
    let way = bearer.ends[1] - bearer.ends[0];
    let square = way.length_squared();
    if square > 0.0 { ((at - bearer.ends[0]).dot(way) / square).clamp(0.0, 1.0) } else { 1.0 }
}

struct Joints {
    joints: Vec<Joint>,
    /// The joint at which each cylinder begins.
    attach: Vec<Option<usize>>,
    ends: Vec<usize>,
}

impl Joints {
    fn add(&mut self, cylinders: &[Cylinder], row: usize, hanging: &[Hanging]) {
        let c = &cylinders[row];
        let radius_at = |share: f64| c.end_radii.map_or(f64::NAN, |[a, b]| base::ops::lerp(a, b, share));
        let mut link = c.link;
        let mut last = match self.attach[row] {
            Some(joint) => joint,
            None => {
                let root = Joint {
                    radius: radius_at(0.0),
                    kind: c.kind,
                    ..Joint::new(c.ends[0], None, c.link, c.line)
                };
                self.push(root)
            }
        };
        self.attach[row] = Some(last);
        let apart = self.joints[last].at.distance(c.ends[0]);
        let bearer = c.parent.map_or(0.0, |p| cylinders[p].radius);
        let whole = c.ends[0].distance(c.ends[1]);
        // Small gaps within an axis close at its next place.
        let least = if link == Link::Follows { 0.5 * whole } else { GAP * bearer };
        let is_gap = apart > least.max(SNAP * whole);
        let base_radius = radius_at(0.0);
        let mut add = |this: &mut Self, last: usize, at: DVec3, radius: f64| {
            let joint = Joint {
                radius,
                base_radius,
                cylinder: c.radius,
                kind: c.kind,
                ..Joint::new(at, Some(last), link, c.line)
            };
            link = Link::Follows;
            this.push(joint)
        };
        if is_gap && c.parent.is_some() {
            last = add(self, last, c.ends[0], radius_at(0.0));
        }
        let foot = last;
        let end =
            hanging.iter().find(|h| cylinders[h.child].link == Link::Follows).map_or(c.ends[1], |next| {
                let begins = cylinders[next.child].ends[0];
                let far = begins.distance(c.ends[1]) > 0.5 * whole;
                if far { c.ends[1] } else { 0.5 * (begins + c.ends[1]) }
            });
        let mut share = 0.0;
        for h in hanging.iter().filter(|h| h.share < 1.0 - SNAP) {
            if h.share <= SNAP {
                self.attach[h.child] = Some(foot);
                continue;
            }
            if h.share - share > SNAP {
                share = h.share;
                last = add(self, last, c.ends[0].lerp(end, share), radius_at(share));
            }
            self.attach[h.child] = Some(last);
        }
        last = add(self, last, end, radius_at(1.0));
        for h in hanging.iter().filter(|h| h.share >= 1.0 - SNAP) {
            self.attach[h.child] = Some(last);
        }
        self.ends[row] = last;
    }

    fn push(&mut self, joint: Joint) -> usize {
        self.joints.push(joint);
        self.joints.len() - 1
    }
}
