//! The user's settings of a tree: a TOML file, or the panels of the Studio.

use base::{Budget, Counted};
use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{
    BladeSpec, BlossomSpec, ColonizeSpec, CompetitionSpec, Envelope, FoliageSpec, GrowthError, GuidedSpec,
    Light, Look, Obstacle, SelfOrganizingSpec, VariationSpec, WoodSpec,
};

/// Method of growth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Method {
    /// Space colonisation (Runions 2007).
    Colonization {
        /// The space of the crown, relative to the root.
        envelope: Envelope,
        /// Attraction points for each tree, 1 to 10 million.
        #[schemars(range(min = 1, max = 10_000_000))]
        points: u32,
        /// Share of the envelope left empty inside, 0 to 0.99.
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 0.99))]
        hollow: f64,
        /// Distances and pulls.
        #[serde(default)]
        steps: ColonizeSpec,
    },
    /// Space colonisation of given points instead of scattered ones.
    Points {
        /// Attraction points, metres; not relative to a root.
        #[schemars(with = "Vec<[f64; 3]>", extend("x-unit" = "m"))]
        points: Vec<DVec3>,
        /// Distances and pulls.
        #[serde(default)]
        steps: ColonizeSpec,
    },
    /// Competition for space in life cycles (Yang et al. 2019).
    Competition(CompetitionSpec),
    /// Buds that compete for light (Palubicki 2009).
    SelfOrganizing(SelfOrganizingSpec),
    /// Buds with their own markers that keep away from others' and follow strokes of a brush (the VR paper).
    Guided(GuidedSpec),
    /// Rules (Prusinkiewicz and Lindenmayer 1990). Obstacles cut off what grows into them.
    Lsystem {
        /// Axiom and rules, one per line.
        rules: String,
        /// Most modules of all trees, 1 to 100 million.
        #[schemars(range(min = 1, max = 100_000_000))]
        most_modules: u32,
    },
}

/// A kind of tree, with its site and appearance. Metres, degrees, +Y up; saved as TOML.
///
/// Every number's unit (`x-unit`), range and default are in its JSON Schema ([`spec::Spec::schema`]).
///
/// ```
/// let spec: growth::TreeSpec = spec::from_toml("name = \"bush\"\n[method]\nkind = \"competition\"\npoints = 300")?;
/// assert_eq!((spec.name.as_str(), spec.roots.len(), spec.bare), ("bush", 1, false));
/// # Ok::<(), spec::SpecFault>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TreeSpec {
    /// Name in files and reports.
    pub name: String,
    /// Scientific name; may be empty.
    pub species: String,
    /// Description in one line.
    pub about: String,
    /// Positions of trees of this kind, metres; they compete. Default one at the origin.
    #[schemars(with = "Vec<[f64; 3]>", extend("x-unit" = "m"))]
    pub roots: Vec<DVec3>,
    /// Obstacles that they grow around; meshes may be named by `file`, in metres, +Y up. Default none.
    pub obstacles: Vec<Obstacle>,
    /// Distance that bark keeps from obstacles where there is room, metres, 0 to 1e6, default 0.05; leaves may touch.
    #[schemars(range(min = 0.0, max = 1e6), extend("x-unit" = "m"))]
    pub clearance_m: f64,
    /// Age at which the trees are shown, in years of [`years`](Self::years); without those, in rounds, years
    /// (self-organising) or rewriting steps (L-systems). Default none: to the end.
    pub age: Option<u32>,
    /// Age of the tree that the method grows, years, 1 to 5000. Younger ages then follow one life, with the same
    /// branches, for every method. Self-organising trees have years of their own. Default none.
    #[schemars(range(min = 1, max = 5000), extend("x-unit" = "a"))]
    pub years: Option<u32>,
    /// Variation of trees of this kind from seed to seed. Default none in size and stance.
    pub variation: VariationSpec,
    /// Method of growth.
    pub method: Method,
    /// Conversion of skeletons to wood.
    pub wood: WoodSpec,
    /// Arrangement of leaves, and their loss.
    pub leaves: FoliageSpec,
    /// Whether there are no leaves at all: a dead or winter tree. Default false.
    pub bare: bool,
    /// The form of a leaf.
    pub blade: BladeSpec,
    /// Flowers in the place of some leaves. Default none.
    pub blossom: BlossomSpec,
    /// Colours and bark.
    pub look: Look,
}

spec::schemas!(TreeSpec = include_str!("../schemas/tree.json"));

impl Default for TreeSpec {
    fn default() -> Self {
        Self {
            name: "tree".into(),
            species: String::new(),
            about: String::new(),
            roots: vec![DVec3::ZERO],
            obstacles: Vec::new(),
            clearance_m: 0.05,
            age: None,
            years: None,
            variation: VariationSpec::default(),
            method: Method::Competition(CompetitionSpec::default()),
            wood: WoodSpec::default(),
            leaves: FoliageSpec::default(),
            bare: false,
            blade: BladeSpec::default(),
            blossom: BlossomSpec::default(),
            look: Look::default(),
        }
    }
}

impl TreeSpec {
    /// Whether both grow to the same wood and leaves: notes, colours, flowers and the form of a blade may differ.
    pub fn grows_like(&self, other: &Self) -> bool {
        // Written out, so that a new field is not forgotten here.
        let Self {
            name,
            species: _,
            about: _,
            roots,
            obstacles,
            clearance_m,
            age,
            years,
            variation,
            method,
            wood,
            leaves,
            bare,
            blade: _,
            blossom: _,
            look: _,
        } = self;
        (name, clearance_m, age, bare) == (&other.name, &other.clearance_m, &other.age, &other.bare)
            && (roots, obstacles, method) == (&other.roots, &other.obstacles, &other.method)
            && (wood, leaves) == (&other.wood, &other.leaves)
            && (years, variation) == (&other.years, &other.variation)
    }

    /// Returns the last age at which the tree still changes, if it is known before it grows: its years.
    pub fn end_of_life(&self) -> Option<u32> {
        match &self.method {
            Method::SelfOrganizing(s) => Some(s.years),
            _ => self.years,
        }
    }

    /// Fails if an age beyond `end` is requested.
    ///
    /// # Errors
    /// [`GrowthError::BeyondLife`].
    pub(crate) fn check_age(&self, end: u32) -> Result<(), GrowthError> {
        match self.age.filter(|&age| age > end.max(1)) {
            None => Ok(()),
            Some(age) => {
                let name = if self.species.is_empty() { &self.name } else { &self.species };
                Err(GrowthError::BeyondLife { name: base::quoted(name), end: end.max(1), age })
            }
        }
    }

    /// Fails if a number is out of its range, if the age lies beyond the years of the tree, or if meshes, point clouds
    /// and roots are more than the budget allows. [`crate::grow`] calls this first; call it yourself before you prepare
    /// parts of the spec.
    ///
    /// # Errors
    /// [`GrowthError::Range`], [`GrowthError::BeyondLife`], [`GrowthError::OverBudget`].
    pub fn check(&self, budget: &Budget) -> Result<(), GrowthError> {
        spec::check(self)?;
        self.end_of_life().map_or(Ok(()), |end| self.check_age(end))?;
        budget.check(Counted::Roots, self.roots.len() as u64, "give fewer roots")?;
        let of_obstacles = self.obstacles.iter().map(|o| match o {
            Obstacle::Mesh { triangles, .. } => triangles.len(),
            _ => 0,
        });
        let envelopes = match &self.method {
            Method::Colonization { envelope, .. } => [Some(envelope), None],
            Method::Competition(s) => [Some(&s.envelope), s.first_envelope.as_ref()],
            Method::Guided(s) => [s.envelope.as_ref(), None],
            Method::SelfOrganizing(SelfOrganizingSpec { light: Light::Space { envelope, .. }, .. }) => {
                [Some(envelope), None]
            }
            _ => [None, None],
        };
        let (mut triangles, mut points) = (of_obstacles.sum::<usize>(), 0);
        for envelope in envelopes.into_iter().flatten() {
            match envelope {
                Envelope::Mesh { triangles: own, .. } => triangles += own.len(),
                Envelope::Points { points: own, .. } => points += own.len(),
                _ => {}
            }
        }
        budget.check(
            Counted::Obstacles,
            triangles as u64,
            "simplify the meshes of obstacles and envelopes",
        )?;
        for obstacle in &self.obstacles {
            if let Obstacle::Mesh { vertices, triangles } = obstacle {
                let slivers = crate::solid::slivers(vertices, triangles);
                budget.check_estimate(
                    Counted::Slivers,
                    slivers,
                    "remesh the obstacle into even triangles",
                )?;
            }
        }
        budget.check(Counted::Points, points as u64, "thin out envelope.points")?;
        Ok(())
    }
}
