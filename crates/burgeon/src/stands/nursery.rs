//! The plants that are grown for a stand, their thickness, and their meshes.

use base::{Report, Run, Seed, Stopped, map_until_cancelled, ops};
use forest::{Stand, Tree};
use growth::TreeSpec;
use mesh::Model;
use skin::Shoots;

use super::placed::{Placed, place};
use super::variant::{BREAST_M, Variant};
use crate::trees::{TreeError, TreeOptions, grow_plant, mesh_plant};

/// Ages at which a species is grown, as shares of the years of its spec: a tree gets the one whose height is nearest to
/// its own.
const AGES: [f64; 4] = [1.0, 0.5, 0.25, 0.12];
/// Number of views along a side of an atlas.
const VIEWS: u32 = 8;
/// Height in pixels for which the first coarser level is made; each further one is for half of it.
const PIXELS: u32 = 192;

/// Selection of the plants that are grown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NurserySpec {
    /// Number of plants of each species and age in the stand, 1 to 64; fewer where it has fewer trees. Default 4.
    pub variants: u32,
    /// Seed from which they are grown.
    pub seed: Seed,
}

impl Default for NurserySpec {
    fn default() -> Self {
        Self { variants: 4, seed: Seed::new(1) }
    }
}

/// Settings for meshing plants of a nursery.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NurseryLook {
    /// Fineness, textures, foliage.
    pub skin: skin::SkinSpec,
    /// The finest level, 0 to `lods`: 0 is the whole plant.
    pub finest: u32,
    /// The coarsest level of meshes, 0 to 6.
    pub lods: u32,
    /// Side in pixels of an atlas of views from all sides, as one more level.
    pub impostor: Option<u32>,
}

impl NurseryLook {
    /// Returns the number of levels at which plants are meshed, at least one.
    pub fn levels(&self) -> u32 {
        self.lods.saturating_sub(self.finest) + 1 + u32::from(self.impostor.is_some())
    }
}

/// Reason why a plant of a stand was not made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NurseryError {
    /// One of the species cannot be grown.
    #[error("species {species}: {error}")]
    Species {
        /// Its name in the stand.
        species: String,
        /// The reason.
        error: Box<TreeError>,
    },
    /// The stand names more species than there are specs.
    #[error("the stand has {species} species, and {specs} specs were given")]
    Specs {
        /// Number of species in the stand.
        species: usize,
        /// Number of specs given.
        specs: usize,
    },
    /// The user asked to stop, or the result would exceed the budget.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

impl From<base::Cancelled> for NurseryError {
    fn from(cancelled: base::Cancelled) -> Self {
        Self::Stopped(Stopped::Cancelled(cancelled))
    }
}

impl NurseryError {
    fn from_tree_error(species: &str, error: TreeError) -> Self {
        match error {
            TreeError::Cancelled(c) => Self::Stopped(Stopped::Cancelled(c)),
            error => Self::Species { species: species.to_owned(), error: Box::new(error) },
        }
    }
}

/// Plants of a stand: grown, measured and discarded; they are grown anew when they are meshed.
///
/// Each species is grown at up to four ages of the life in its spec, each age in `variants` individuals, as the trees
/// of the stand need them. Stems are made thicker or thinner (the exponent of their pipe model changes, twigs stay) so
/// that the k-th of n individuals has the slenderness of the k-th n-th of its trees.
#[derive(Clone, Debug)]
pub struct Nursery {
    names: Vec<String>,
    specs: Vec<TreeSpec>,
    seed: Seed,
    /// Heights of the first individual of each species at its ages.
    heights: Vec<Vec<f64>>,
    /// Variants, sorted by species, age and number.
    variants: Vec<Variant>,
    /// First row and number of variants, by species and age.
    rows: Vec<Vec<(u32, u32)>>,
    /// The shoots of the first individual of each species, which all of its plants show where they fit: one atlas for all.
    painted: Vec<Option<Shoots>>,
}

/// A plant that was grown, measured and thrown away.
struct Seedling {
    variant: Variant,
    /// Shoots of the oldest first individual of a species.
    shoots: Option<Shoots>,
}

impl Nursery {
    /// Grows the plants that a stand needs; `specs`: of its species, in their order. The same bits for any executor.
    ///
    /// Cost: one growth for each species and age, and one for each variant; no meshes.
    ///
    /// # Errors
    /// [`NurseryError`] with the name of the species.
    pub fn plan(
        stand: &Stand,
        specs: &[TreeSpec],
        spec: &NurserySpec,
        run: &Run<'_>,
    ) -> Result<Self, NurseryError> {
        if specs.len() < stand.species.len() {
            return Err(NurseryError::Specs { species: stand.species.len(), specs: specs.len() });
        }
        let mut nursery = Self {
            names: stand.species.clone(),
            specs: specs.to_vec(),
            seed: spec.seed,
            heights: Vec::new(),
            variants: Vec::new(),
            rows: vec![Vec::new(); stand.species.len()],
            painted: vec![None; stand.species.len()],
        };
        let ages: Vec<(u16, u8)> = (0_u16..)
            .zip(&specs[..stand.species.len()])
            .flat_map(|(s, spec)| {
                (0_u8..).take(if spec.years.is_some() { AGES.len() } else { 1 }).map(move |a| (s, a))
            })
            .collect();
        let firsts = nursery.grow_all(&ages.iter().map(|&(s, a)| (s, a, 0)).collect::<Vec<_>>(), run)?;
        nursery.heights = vec![Vec::new(); stand.species.len()];
        for Seedling { variant, shoots } in firsts {
            let species = usize::from(variant.species);
            nursery.heights[species].push(variant.height_m);
            nursery.painted[species] = shoots.or(nursery.painted[species].take());
        }
        // Trees of each species and age.
        let mut groups: Vec<Vec<Vec<u32>>> =
            nursery.heights.iter().map(|h| vec![Vec::new(); h.len()]).collect();
        for (row, tree) in (0..).zip(&stand.trees) {
            groups[usize::from(tree.species)][nursery.age_of(tree)].push(row);
        }
        let mut wanted = Vec::new();
        for (s, of) in (0_u16..).zip(&groups) {
            for (a, trees) in (0_u8..).zip(of) {
                let count = spec.variants.max(1).min(u32::try_from(trees.len()).unwrap_or(u32::MAX));
                let first = u32::try_from(wanted.len()).unwrap_or(u32::MAX);
                nursery.rows[usize::from(s)].push((first, count));
                wanted.extend((0..count).map(|n| (s, a, n)));
            }
        }
        nursery.variants = nursery.grow_all(&wanted, run)?.into_iter().map(|s| s.variant).collect();
        for variant in &mut nursery.variants {
            let trees = &groups[usize::from(variant.species)][usize::from(variant.age)];
            let count = nursery.rows[usize::from(variant.species)][usize::from(variant.age)].1;
            let mut times: Vec<f64> =
                trees.iter().filter_map(|&t| wanted_thickness(variant, &stand.trees[t as usize])).collect();
            times.sort_unstable_by(f64::total_cmp);
            // The middle of the k-th n-th.
            let place = (2 * variant.number as usize + 1) * times.len() / (2 * count.max(1) as usize);
            if let Some(times) = times.get(place) {
                variant.thicken(*times);
            }
        }
        Ok(nursery)
    }

    /// Returns all plants.
    pub fn variants(&self) -> &[Variant] {
        &self.variants
    }

    /// Returns the name of a variant's files: `oak-0-2`.
    pub fn name(&self, variant: u32) -> String {
        let v = &self.variants[variant as usize];
        let species = &self.names[usize::from(v.species)];
        let stem = species.rsplit(['/', '\\']).next().unwrap_or_default();
        let stem = formats::file_name(stem.strip_suffix(".toml").unwrap_or(stem), "tree");
        // Two paths may have the same ending.
        let same = |other: &String| {
            let other = other.rsplit(['/', '\\']).next().unwrap_or_default();
            let other = other.strip_suffix(".toml").unwrap_or(other);
            formats::file_name(other, "tree").to_lowercase() == stem.to_lowercase()
        };
        let twin = self.names[..usize::from(v.species)].iter().filter(|n| same(n)).count();
        let twin = if twin > 0 { format!("-{}", twin + 1) } else { String::new() };
        format!("{stem}{twin}-{}-{}", v.age, v.number)
    }

    /// Returns the plant that stands for a tree, and its pose. `None` for a tree of a species that the stand did not
    /// have.
    pub fn place(&self, tree: &Tree) -> Option<Placed> {
        let heights = self.heights.get(usize::from(tree.species)).filter(|h| !h.is_empty())?;
        debug_assert!(heights.iter().all(|h| *h > 0.0), "plants are above the ground");
        let &(first, count) = self.rows.get(usize::from(tree.species))?.get(self.age_of(tree))?;
        let own = self.variants.get(first as usize..(first + count) as usize)?;
        place(own, tree, self.seed).map(|p| Placed { variant: p.variant + first, ..p })
    }

    /// Returns the meshes of a variant, finest first: grown again, meshed at each level.
    ///
    /// # Errors
    /// [`NurseryError`].
    pub fn models(
        &self,
        variant: u32,
        look: &NurseryLook,
        run: &Run<'_>,
    ) -> Result<Vec<Model>, NurseryError> {
        let v = &self.variants[variant as usize];
        let species = &self.names[usize::from(v.species)];
        let failed = |e: TreeError| NurseryError::from_tree_error(species, e);
        let (spec, seed) = self.individual(v.species, v.age, v.number);
        let mut plant = grow_plant(&spec, seed, run).map_err(failed)?;
        let shoot = plant.shoot();
        for (radius, axis) in plant.nodes.radius_m.iter_mut().zip(&plant.nodes.axis) {
            if shoot.get(axis.index()).copied().unwrap_or(false) {
                *radius = v.thickened(*radius);
            }
        }
        let options = TreeOptions { skin: look.skin.clone(), ..TreeOptions::default() };
        // Textures follow from the species, so that its individuals share them.
        let skin_seed = self.species_seed(v.species);
        let painted = self.painted[usize::from(v.species)].as_ref();
        let mut models = Vec::new();
        for level in look.finest.min(look.lods)..=look.lods.min(6) {
            let model = mesh_plant(&plant, (&spec, skin_seed), &options, (level, painted), run);
            models.push(model.map_err(|e| failed(e.into()))?);
        }
        if let Some(size) = look.impostor {
            // The level made for pictures of the size of its views: finer ones look the same and take longer.
            let level =
                (1..=look.lods).rev().find(|l| PIXELS >> (l - 1) >= size / VIEWS).unwrap_or(look.lods.min(1));
            let own = models.get(level.wrapping_sub(look.finest) as usize);
            let made = if own.is_some() {
                None
            } else {
                let made = mesh_plant(&plant, (&spec, skin_seed), &options, (level, painted), run);
                Some(made.map_err(|e| failed(e.into()))?)
            };
            if let Some(of) = own.or(made.as_ref())
                && let Some(far) = render::impostor(of, size, run)?
            {
                models.push(far);
            }
        }
        let name = self.name(variant);
        models.iter_mut().for_each(|m| m.name.clone_from(&name));
        Ok(models)
    }

    /// Reports in which ways a stand's plants differ from its trees: once, with the numbers.
    pub fn tell(&self, misfits: &super::Misfits, report: &mut Report) {
        misfits.tell(report);
    }

    /// Returns the age whose height is nearest to a tree's.
    fn age_of(&self, tree: &Tree) -> usize {
        let heights = &self.heights[usize::from(tree.species)];
        let off = |h: f64| ops::ln(h / tree.height_m.max(0.01)).abs();
        let nearest = (0..heights.len()).min_by(|&a, &b| off(heights[a]).total_cmp(&off(heights[b])));
        nearest.unwrap_or(0)
    }

    fn species_seed(&self, species: u16) -> Seed {
        let name = self.names[usize::from(species)].bytes();
        name.fold(self.seed, |seed, byte| seed.child(u64::from(byte)))
    }

    /// Returns the spec and the seed of an individual: one number is the same life at each age.
    fn individual(&self, species: u16, age: u8, number: u32) -> (TreeSpec, Seed) {
        let mut spec = self.specs[usize::from(species)].clone();
        if let Some(years) = spec.years {
            let share = AGES.get(usize::from(age)).copied().unwrap_or(1.0);
            let whole = spec.age.unwrap_or(years).min(years);
            spec.age = Some(ops::whole((f64::from(whole) * share).round()).max(1));
        }
        (spec, self.species_seed(species).child(u64::from(number)))
    }

    fn grow_all(&self, wanted: &[(u16, u8, u32)], run: &Run<'_>) -> Result<Vec<Seedling>, NurseryError> {
        let grown = map_until_cancelled(run, wanted.len(), |k| {
            let (species, age, number) = wanted[k];
            let (spec, seed) = self.individual(species, age, number);
            let alone = Run { executor: &base::Serial, ..*run };
            let plant = grow_plant(&spec, seed, &alone);
            plant
                .map(|p| Seedling {
                    variant: Variant::measure(&p, wanted[k]),
                    shoots: if (age, number) == (0, 0) { Shoots::find(&p) } else { None },
                })
                .map_err(|e| NurseryError::from_tree_error(&self.names[usize::from(species)], e))
        })?;
        grown.into_iter().collect()
    }
}

/// Returns the factor by which a variant has to be thickened to have a tree's diameter; `None` for a tree without one.
fn wanted_thickness(variant: &Variant, tree: &Tree) -> Option<f64> {
    let (wide, tall) = (tree.crown_width_m / variant.crown_width_m, tree.height_m / variant.height_m);
    let grown = variant.diameter_m(BREAST_M / tall) * wide;
    let times = tree.dbh_m / grown;
    (tree.dbh_m > 0.0 && times.is_finite() && times > 0.0).then_some(times)
}
