//! Distribution of the resource to buds: the extended Borchert-Honda model and the priority model.
//!
//! `light of each bud -> summed towards the base -> vigour distributed towards the tips`

use super::grove::{Grove, NONE, WAITS};

/// Rule of the distribution at a fork.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Sharing {
    /// `lambda` for the main axis.
    Fork { lambda: f64 },
    /// Weights by rank along each axis.
    Rank { w_max: f64, w_min: f64, kappa: u32 },
}

/// Vigour below which it is not distributed any further: a bud needs 1, and rounding does not add a thousandth.
const SCANT: f64 = 0.999;

/// A bud that received vigour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fed {
    pub(super) joint: usize,
    /// The axillary bud; `None` is the terminal one.
    pub(super) bud: Option<usize>,
    pub(super) vigour: f64,
}

/// Sums and shares of one cycle; reused between cycles so that nothing is allocated.
#[derive(Clone, Debug, Default)]
pub(super) struct Flow {
    /// Light gathered by each joint and all above it.
    pub(super) light: Vec<f64>,
    /// Number of internodes of each joint's subtree, including itself.
    pub(super) size: Vec<f64>,
    /// Vigour that enters each joint.
    vigour: Vec<f64>,
    /// The buds that receive it, in the order of their joints, if it is more than scant.
    pub(super) fed: Vec<Fed>,
    items: Vec<Item>,
}

#[derive(Clone, Copy, Debug)]
struct Item {
    light: f64,
    target: Target,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Target {
    Tip(usize),
    Bud(usize, usize),
    Branch(usize),
}

impl Flow {
    /// Sums light from the tips to the bases. `bud_light` is that of any bud at each joint.
    pub(super) fn gather(&mut self, grove: &Grove, bud_light: &[f64]) {
        let n = grove.len();
        self.light.clear();
        self.light.resize(n, 0.0);
        self.size.clear();
        self.size.resize(n, 1.0);
        let (sums, sizes, bud_light) = (&mut self.light[..n], &mut self.size[..n], &bud_light[..n]);
        for (j, (main, parent)) in grove.main.iter().zip(&grove.skeleton.parent).enumerate().rev() {
            let mut light = sums[j];
            if *main == NONE {
                light += bud_light[j];
            }
            light += f64::from(grove.waiting_buds(j)) * bud_light[j];
            // Children come after their parents: theirs have been added already.
            sums[j] = light;
            if let Some(p) = parent {
                sums[p.index()] += light;
                sizes[p.index()] += sizes[j];
            }
        }
    }

    /// Distributes `alpha` times the light of each tree among its buds.
    pub(super) fn share(&mut self, grove: &Grove, bud_light: &[f64], alpha: f64, sharing: Sharing) {
        let n = grove.len();
        self.vigour.clear();
        self.vigour.resize(n, 0.0);
        self.fed.clear();
        for j in 0..n {
            if grove.skeleton.parent[j].is_none() {
                self.vigour[j] = alpha * self.light[j];
            }
            if self.vigour[j] < SCANT {
                continue;
            }
            match sharing {
                Sharing::Fork { lambda } => self.share_fork(grove, bud_light, j, lambda),
                Sharing::Rank { .. } => {
                    if grove.starts_axis(j) {
                        self.share_axis(grove, bud_light, j, sharing);
                    }
                }
            }
        }
        if matches!(sharing, Sharing::Rank { .. }) {
            base::sort_by_key(&mut self.fed, |f| (f.joint, f.bud));
        }
    }

    fn feed(&mut self, joint: usize, bud: Option<usize>, vigour: f64) {
        if vigour >= SCANT {
            self.fed.push(Fed { joint, bud, vigour });
        }
    }

    /// Splits `v_m = v lambda Q_m / (lambda Q_m + (1 - lambda) Q_l)`, with the rest for the laterals (section 4.2).
    fn share_fork(&mut self, grove: &Grove, bud_light: &[f64], j: usize, lambda: f64) {
        let v = self.vigour[j];
        let main = grove.main[j];
        let q_main = if main == NONE { bud_light[j] } else { self.light[main as usize] };
        let q_side = (self.light[j] - q_main).max(0.0);
        let (m, l) = (lambda * q_main, (1.0 - lambda) * q_side);
        // A fork in the dark splits by lambda alone.
        let share = if m + l > 0.0 { m / (m + l) } else { lambda };
        if main == NONE {
            self.feed(j, None, v * share);
        } else {
            self.vigour[main as usize] = v * share;
        }
        let rest = v * (1.0 - share);
        if q_side > 0.0 && rest > 0.0 {
            for k in grove.bud_range(j) {
                match grove.lateral[k] {
                    NONE => {}
                    WAITS => self.feed(j, Some(k), rest * bud_light[j] / q_side),
                    child => self.vigour[child as usize] = rest * self.light[child as usize] / q_side,
                }
            }
        }
    }

    /// Distributes by the priority model: the tip of the axis first, then its lateral buds and branches by decreasing
    /// light; weights decrease linearly from `w_max` to `w_min` at rank `kappa`.
    fn share_axis(&mut self, grove: &Grove, bud_light: &[f64], start: usize, sharing: Sharing) {
        let Sharing::Rank { w_max, w_min, kappa } = sharing else { return };
        let v = self.vigour[start];
        let mut items = core::mem::take(&mut self.items);
        items.clear();
        let mut j = start;
        loop {
            for k in grove.bud_range(j) {
                match grove.lateral[k] {
                    NONE => {}
                    WAITS => items.push(Item { light: bud_light[j], target: Target::Bud(j, k) }),
                    child => {
                        let c = child as usize;
                        items.push(Item { light: self.light[c], target: Target::Branch(c) });
                    }
                }
            }
            if grove.main[j] == NONE {
                break;
            }
            j = grove.main[j] as usize;
        }
        items.push(Item { light: bud_light[j], target: Target::Tip(j) });
        let mean = |i: &Item| match i.target {
            Target::Tip(_) => f64::INFINITY,
            Target::Bud(..) => i.light,
            Target::Branch(c) => i.light / self.size[c],
        };
        // Stable: equal light keeps the order along the axis, tip last before it is put first.
        base::sort_by(&mut items, |a, b| mean(b).total_cmp(&mean(a)));
        let weight = |rank: usize| {
            let t = (rank as f64 / f64::from(kappa.max(1))).min(1.0);
            w_max + (w_min - w_max) * t
        };
        let whole: f64 = items.iter().enumerate().map(|(r, i)| i.light * weight(r)).sum();
        if whole > 0.0 {
            for (rank, item) in items.iter().enumerate() {
                let part = v * item.light * weight(rank) / whole;
                match item.target {
                    Target::Tip(j) => self.feed(j, None, part),
                    Target::Bud(j, k) => self.feed(j, Some(k), part),
                    Target::Branch(c) => self.vigour[c] = part,
                }
            }
        }
        self.items = items;
    }
}
