//! Height, stem, crown and age of a species, each from the others, with the interval of nineteen trees in twenty.
//!
//! `name -> Allometry; measured figures -> all figures with intervals`

use base::ops;

/// Height above the foot at which stems are measured, metres.
pub const BREAST_M: f64 = 1.3;
/// Half the width of an interval that holds 95 % of a normal distribution, in standard deviations.
const DEVIATIONS_95: f64 = 1.96;
/// Exponent of the growth curve of the diameter, a little above 1: only the first years have slow growth.
const CURVE: f64 = 1.3;
/// Largest share of the height or diameter of the oldest trees for which an inverse is computed: beyond it, every age
/// is equally likely.
const ALMOST: f64 = 0.98;
/// Crowns in closed stands cover an area in proportion to this power of the diameter (Sitch et al. 2003, after Zeide
/// 1993).
const COVER_POWER: f64 = 1.6;

/// Growth form that several species share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FunctionalGroup {
    /// Trees with broad leaves.
    Broadleaf,
    /// Trees with needles or scales.
    Conifer,
    /// Palms and tree ferns, whose stems hardly thicken.
    Palm,
    /// Shrubs, climbers, succulents and bamboos, which have no single trunk to measure.
    Shrub,
    /// Herbs and grasses.
    Herb,
}

impl FunctionalGroup {
    /// Returns the standard deviation of the logarithm of height about the curve. It follows from stands and
    /// free-standing trees, which differ by a factor of two at one diameter.
    const fn height_deviation(self) -> f64 {
        match self {
            Self::Broadleaf | Self::Conifer => 0.2,
            Self::Palm => 0.5,
            Self::Shrub | Self::Herb => 0.35,
        }
    }

    /// Returns the standard deviation of the logarithm of age about the curve: sites differ more than species.
    const fn age_deviation(self) -> f64 {
        match self {
            Self::Broadleaf | Self::Conifer => 0.4,
            _ => 0.6,
        }
    }

    /// Returns the years that a plant needs to reach breast height.
    const fn years_to_breast(self) -> f64 {
        match self {
            Self::Broadleaf => 4.0,
            Self::Conifer => 6.0,
            Self::Palm => 5.0,
            Self::Shrub | Self::Herb => 0.0,
        }
    }

    /// Returns the square metres of ground under the crown of a tree of one metre of diameter in a closed stand.
    const fn cover_m2(self) -> f64 {
        match self {
            Self::Broadleaf => 230.0,
            Self::Conifer => 150.0,
            Self::Palm => 200.0,
            Self::Shrub | Self::Herb => 100.0,
        }
    }
}

/// Crown of a free-standing tree: `ln(width / m) = b0 + b1 ln(dbh / cm)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crown {
    pub(crate) b0: f64,
    pub(crate) b1: f64,
    /// Variance of the residuals of the logarithm.
    pub(crate) variance: f64,
    /// The equation is from Hasenauer (1997); otherwise it has the same form with figures chosen by us.
    pub(crate) is_published: bool,
}

/// Stem of a species with a trunk to measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stem {
    pub(crate) thick_m: f64,
    pub(crate) free: f64,
    pub(crate) stand: f64,
    pub(crate) dbh_50_m: f64,
    pub(crate) crown: Crown,
}

/// Surroundings of a tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Setting {
    /// Streets, parks, orchards: crowns spread to the sides, and stems are stout.
    #[default]
    Free,
    /// A closed stand: trees are high and slender.
    Stand,
}

base::words!(Setting { Free = "free", Stand = "stand" });

/// A value with the interval of nineteen trees in twenty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Predicted {
    /// Middle of the distribution of its logarithm.
    pub value: f64,
    /// The low end of the interval.
    pub low: f64,
    /// The high end.
    pub high: f64,
}

impl Predicted {
    fn spread(value: f64, deviation: f64) -> Self {
        let factor = ops::exp(DEVIATIONS_95 * deviation);
        Self { value, low: value / factor, high: value * factor }
    }
}

/// Measures of one tree; none if not measured.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measured {
    /// Height, metres, above 0.
    pub height_m: Option<f64>,
    /// Diameter at breast height, metres, above 0.
    pub dbh_m: Option<f64>,
    /// Width of the crown, metres, above 0.
    pub crown_width_m: Option<f64>,
    /// Age, years, 0 and more.
    pub age_years: Option<f64>,
}

/// All figures of one tree: measured ones are unchanged and have an interval of width 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// Height, metres.
    pub height_m: Predicted,
    /// Diameter at breast height, metres; 0 for trees below 1.3 m and plants without a trunk.
    pub dbh_m: Predicted,
    /// Width of the crown, metres.
    pub crown_width_m: Predicted,
    /// Age, years.
    pub age_years: Predicted,
}

/// The relations of one species.
///
/// | relation | form |
/// |---|---|
/// | height ~ diameter | `h = 1.3 + (top - 1.3) (1 - exp(-s d / (top - 1.3)))` (Meyer 1940) |
/// | crown width ~ diameter | `ln w = b0 + b1 ln d` (Hasenauer 1997: open-grown trees) |
/// | diameter ~ age | `d = thick (1 - exp(-k t))^1.3` (Richards 1959) |
/// | ground cover ~ diameter in stands | `a = c d^1.6` (Sitch et al. 2003) |
///
/// Height, age and cover are general forms with figures of our own, based on what floras report of old trees, and
/// have wide intervals. Crowns are published for spruce, larch, pine, beech, oak, ash, maple and other broadleaves of
/// Central Europe.
///
/// ```
/// use forest::{Allometry, Measured, Setting};
/// let oak = Allometry::find("Quercus robur")?.allometry;
/// let tree = oak.fill(&Measured { dbh_m: Some(0.5), ..Measured::default() }, Setting::Free);
/// assert!((14.0..20.0).contains(&tree.height_m.value) && (10.0..14.0).contains(&tree.crown_width_m.value));
/// assert_eq!(Allometry::find("Quercus rubor").unwrap_err().nearest, Some("Quercus robur"));
/// # Ok::<(), forest::UnknownSpecies>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Allometry {
    /// The word of the preset.
    pub preset: &'static str,
    /// Scientific name.
    pub latin: &'static str,
    /// Other names, in lower case.
    pub names: &'static [&'static str],
    /// Its form of growth.
    pub group: FunctionalGroup,
    /// Height of old plants, metres.
    pub top_m: f64,
    pub(crate) stem: Option<Stem>,
    pub(crate) width_of_height: f64,
    /// Light demand: 0 grows in deep shade, 1 only in full light.
    pub light: f64,
    /// Age that one plant in a hundred reaches, years.
    pub life_years: f64,
    /// Mean distance from a plant to its seedlings, metres.
    pub spread_m: f64,
}

impl Allometry {
    /// Returns whether the crown's relation is published for this species or its kind.
    pub fn has_published_crown(&self) -> bool {
        self.stem.is_some_and(|stem| stem.crown.is_published)
    }

    /// Returns whether it has a trunk to measure.
    pub const fn has_trunk(&self) -> bool {
        self.stem.is_some()
    }

    /// Returns the height in metres for a diameter in metres.
    pub fn height_m(&self, dbh_m: f64, setting: Setting) -> f64 {
        let Some(stem) = self.stem else { return self.top_m };
        let room = self.top_m - BREAST_M;
        BREAST_M + room * (1.0 - ops::exp(-stem.slope(setting) * dbh_m.max(0.0) / room))
    }

    /// Returns the diameter in metres for a height in metres: the inverse of [`height_m`](Self::height_m), up to
    /// almost the height of old trees; 0 below 1.3 m.
    pub fn dbh_m(&self, height_m: f64, setting: Setting) -> f64 {
        let Some(stem) = self.stem else { return 0.0 };
        let room = self.top_m - BREAST_M;
        let share = ((height_m - BREAST_M) / room).clamp(0.0, ALMOST);
        -room / stem.slope(setting) * ops::ln(1.0 - share)
    }

    /// Returns the width in metres of the crown of a free-standing tree, for its diameter and height in metres.
    pub fn crown_width_m(&self, dbh_m: f64, height_m: f64) -> f64 {
        let Some(stem) = self.stem else { return self.width_of_height * height_m };
        // A sapling is narrower than high.
        let least = SAPLING * height_m;
        if dbh_m <= 0.0 {
            return least;
        }
        ops::exp(stem.crown.b0 + stem.crown.b1 * ops::ln(100.0 * dbh_m)).max(least)
    }

    /// Returns the width in metres of the crown of a tree in a closed stand: at most that of a free-standing one.
    pub fn stand_crown_width_m(&self, dbh_m: f64, height_m: f64) -> f64 {
        let free = self.crown_width_m(dbh_m, height_m);
        if self.stem.is_none() || dbh_m <= 0.0 {
            return free;
        }
        // The diameter to half the power gives the width of a disc of that area.
        let width = 2.0 * (self.group.cover_m2() / ops::PI).sqrt() * ops::powf(dbh_m, 0.5 * COVER_POWER);
        width.min(free)
    }

    /// Returns the rate of the growth curve of the diameter, per year.
    fn rate(stem: &Stem) -> f64 {
        let share = (stem.dbh_50_m / stem.thick_m).min(ALMOST);
        -ops::ln(1.0 - ops::powf(share, 1.0 / CURVE)) / 50.0
    }

    /// Returns the age in years, from germination, of a free-standing tree of a diameter in metres.
    pub fn age_years(&self, dbh_m: f64, height_m: f64) -> f64 {
        let Some(stem) = self.stem else {
            return -ops::ln(1.0 - (height_m / self.top_m).clamp(0.0, ALMOST)) * self.life_years / 4.0;
        };
        let to_breast = self.group.years_to_breast();
        if dbh_m <= 0.0 {
            return to_breast * (height_m / BREAST_M).clamp(0.0, 1.0);
        }
        let share = ops::powf((dbh_m / stem.thick_m).clamp(0.0, ALMOST), 1.0 / CURVE);
        to_breast - ops::ln(1.0 - share) / Self::rate(&stem)
    }

    /// Returns the diameter in metres of a free-standing tree at an age in years: the inverse of
    /// [`age_years`](Self::age_years).
    pub fn dbh_at_age_m(&self, age_years: f64) -> f64 {
        let Some(stem) = self.stem else { return 0.0 };
        let years = age_years - self.group.years_to_breast();
        if years <= 0.0 {
            return 0.0;
        }
        stem.thick_m * ops::powf(1.0 - ops::exp(-Self::rate(&stem) * years), CURVE)
    }

    /// Returns the diameter in metres after some years of growth as a free-standing tree.
    pub(crate) fn dbh_after_m(&self, dbh_m: f64, years: f64) -> f64 {
        let Some(stem) = self.stem else { return 0.0 };
        let share = ops::powf((dbh_m / stem.thick_m).min(1.0), 1.0 / CURVE);
        let left = (1.0 - share) * ops::exp(-Self::rate(&stem) * years);
        // Rounding must not make a stem thinner.
        (stem.thick_m * ops::powf(1.0 - left, CURVE)).max(dbh_m)
    }

    /// Returns the height per diameter of a young stem, metres per metre.
    pub(crate) fn slope(&self, setting: Setting) -> f64 {
        self.stem.map_or(0.0, |stem| stem.slope(setting))
    }

    /// Returns the height in metres of a plant at an age in years, with the diameter for that age.
    fn height_at_age_m(&self, age_years: f64, dbh_m: f64, setting: Setting) -> f64 {
        if self.stem.is_none() {
            return (self.top_m * (1.0 - ops::exp(-4.0 * age_years / self.life_years))).max(LOWEST_M);
        }
        let to_breast = self.group.years_to_breast();
        if dbh_m <= 0.0 {
            return (BREAST_M * (age_years / to_breast).min(1.0)).max(LOWEST_M);
        }
        self.height_m(dbh_m, setting)
    }

    /// Computes all figures of a tree from those that were measured, which stay as they are. A tree without any gets
    /// those of a third of its life, at most 40 years.
    ///
    /// The diameter follows from the height, else from the crown, else from the age; the others follow from the
    /// diameter. Intervals hold 95 % of the trees of the species about the relation, and widen where one is inverted.
    pub fn fill(&self, measured: &Measured, setting: Setting) -> Figures {
        let exact = |value| Predicted { value, low: value, high: value };
        let group = self.group;
        let (dbh, unsure) = self.stem_of(measured, setting);
        let rough_age = measured.age_years.unwrap_or_else(|| self.typical_age_years());
        let height = measured.height_m.map(exact).unwrap_or_else(|| {
            let value = match (self.stem, measured.crown_width_m) {
                (None, Some(width)) => width / self.width_of_height,
                _ if dbh > 0.0 => self.height_m(dbh, setting),
                _ => self.height_at_age_m(rough_age, dbh, setting),
            };
            let with_age = if self.stem.is_none() { group.age_deviation() } else { 0.0 };
            Predicted::spread(value, group.height_deviation().max(with_age) + 0.6 * unsure)
        });
        let crown = measured.crown_width_m.map(exact).unwrap_or_else(|| {
            let value = match setting {
                Setting::Free => self.crown_width_m(dbh, height.value),
                Setting::Stand => self.stand_crown_width_m(dbh, height.value),
            };
            let own = self.stem.map_or(WIDTH_DEVIATION, |stem| stem.crown.variance.sqrt());
            Predicted::spread(value, own + 0.6 * unsure)
        });
        let age = measured.age_years.map(exact).unwrap_or_else(|| {
            Predicted::spread(self.age_years(dbh, height.value), group.age_deviation() + 0.6 * unsure)
        });
        let dbh = measured.dbh_m.map_or_else(|| Predicted::spread(dbh, unsure), exact);
        Figures { height_m: height, dbh_m: dbh, crown_width_m: crown, age_years: age }
    }

    /// Returns the diameter from the measured figures, and the standard deviation of its logarithm.
    fn stem_of(&self, measured: &Measured, setting: Setting) -> (f64, f64) {
        let Some(stem) = self.stem else { return (0.0, 0.0) };
        let group = self.group;
        // An inverse has a wider interval: the height levels off while the diameter grows on.
        const INVERSE: f64 = 1.5;
        match *measured {
            Measured { dbh_m: Some(dbh), .. } => (dbh, 0.0),
            Measured { height_m: Some(height), .. } => {
                (self.dbh_m(height, setting), INVERSE * group.height_deviation())
            }
            Measured { crown_width_m: Some(width), .. } => {
                let cm = ops::exp((ops::ln(width) - stem.crown.b0) / stem.crown.b1);
                ((0.01 * cm).min(stem.thick_m), stem.crown.variance.sqrt() / stem.crown.b1)
            }
            Measured { age_years: Some(age), .. } => (self.dbh_at_age_m(age), group.age_deviation()),
            _ => (self.dbh_at_age_m(self.typical_age_years()), 2.0 * group.age_deviation()),
        }
    }

    /// Returns the age that is assumed for a tree without any figure.
    fn typical_age_years(&self) -> f64 {
        (self.life_years / 3.0).min(40.0)
    }
}

/// Crown width of saplings, as a share of their height.
const SAPLING: f64 = 0.3;
/// Least height of a plant, metres.
const LOWEST_M: f64 = 0.05;
/// Standard deviation of the logarithm of the width of plants without a trunk.
const WIDTH_DEVIATION: f64 = 0.4;

impl Stem {
    const fn slope(&self, setting: Setting) -> f64 {
        match setting {
            Setting::Free => self.free,
            Setting::Stand => self.stand,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn species(name: &str) -> &'static Allometry {
        Allometry::find(name).expect("it is known").allometry
    }

    #[test]
    fn inverses_lead_back() {
        for s in Allometry::all().iter().filter(|s| s.has_trunk()) {
            let thick = s.stem.expect("a trunk").thick_m;
            for setting in Setting::ALL {
                for share in [0.02, 0.1, 0.3] {
                    let dbh = share * thick;
                    let height = s.height_m(dbh, setting);
                    if height < 0.95 * s.top_m {
                        let back = s.dbh_m(height, setting);
                        assert!((back / dbh - 1.0).abs() < 1e-9, "{} {dbh} {back}", s.preset);
                    }
                    let age = s.age_years(dbh, height);
                    assert!((s.dbh_at_age_m(age) / dbh - 1.0).abs() < 1e-9, "{} {age}", s.preset);
                }
            }
            assert!(
                (s.dbh_at_age_m(50.0 + s.group.years_to_breast()) / s.stem.unwrap().dbh_50_m - 1.0).abs()
                    < 1e-9
            );
        }
    }

    #[test]
    fn hasenauers_crowns_are_as_published() {
        // exp(-0.3232 + 0.6441 ln 30), and so on, by hand.
        for (name, dbh_m, width_m) in [("spruce", 0.3, 6.471), ("beech", 0.4, 12.258), ("oak", 0.5, 11.815)] {
            let width = species(name).crown_width_m(dbh_m, 10.0);
            assert!((width - width_m).abs() < 0.01, "{name} {width}");
        }
    }

    #[test]
    fn what_was_measured_stays_and_the_rest_has_intervals() {
        let measured = Measured { height_m: Some(17.25), crown_width_m: Some(9.5), ..Measured::default() };
        for s in Allometry::all() {
            for setting in Setting::ALL {
                let f = s.fill(&measured, setting);
                assert_eq!((f.height_m.value, f.crown_width_m.value), (17.25, 9.5), "{}", s.preset);
                assert_eq!((f.height_m.low, f.height_m.high), (17.25, 17.25));
                assert_eq!(f.dbh_m.value > 0.0, s.has_trunk(), "{}", s.preset);
                for p in [f.dbh_m, f.age_years] {
                    assert!(
                        p.low <= p.value && p.value <= p.high && p.high.is_finite(),
                        "{} {p:?}",
                        s.preset
                    );
                }
                let empty = s.fill(&Measured::default(), setting);
                assert!(empty.height_m.value > 0.0 && empty.crown_width_m.value > 0.0, "{}", s.preset);
                assert!(empty.height_m.value <= s.top_m && empty.height_m.high > empty.height_m.low);
            }
        }
    }
}
