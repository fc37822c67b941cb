//! Scans of one plant on several days -> the plant on any day.

use base::{Run, Seed};
use bloom::{
    BloomError, CleanSpec, GrowthLaw, LawSpec, MotionSpec, OrganPoints, RegisterSpec, ScanOrgan, SegmentSpec,
    Settled, Stage,
};
use glam::DVec3;
use makers::SeedlingError;
use mesh::PointCloud;

use crate::made::MadePlant;
use crate::scanned::{SeedlingOptions, make_seedling};

/// Least points of an organ: no motion of a smaller one can be found.
const FEWEST_POINTS: usize = 8;

/// Scans of one plant on several days: cleaned, cut into organs that are found again, with the plant's own motion
/// removed.
///
/// ```
/// use burgeon::{Run, ScannedDays, Seed, glam::DVec3, mesh::PointCloud};
/// let leaf = |length: f64| {
///     let point = |k: i32| DVec3::new(0.01 * f64::from(k % 20), length * f64::from(k / 20) / 30.0, 0.0);
///     PointCloud { points: (0..600).map(point).collect(), ..PointCloud::default() }
/// };
/// let scans = [(0.0, leaf(0.1)), (2.0, leaf(0.2))];
/// let days = ScannedDays::new(&scans, true, Seed::new(1), &Run::plain())?;
/// let points = days.organs(1.0, None, &Run::plain())?.remove(0).points;
/// let high = points.iter().map(|p| p.y).fold(0.0, f64::max) - points.iter().map(|p| p.y).fold(1.0, f64::min);
/// assert!((0.12..0.18).contains(&high), "half-way between both days: {high}");
/// # Ok::<(), burgeon::bloom::BloomError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ScannedDays {
    settled: Settled,
}

impl ScannedDays {
    /// Makes them from clouds, each with its day, metres, +Y up; days increase. `whole`: each cloud is one organ, such
    /// as a leaf that was cut off; otherwise stem and leaves are separated where every scan shows both.
    ///
    /// Stray points and a ground plane are removed first. Points keep the colours of the clouds. Cost: n log n, and a
    /// registration for each organ and step.
    ///
    /// # Errors
    /// [`BloomError`]: too few points, or stopped.
    pub fn new(
        scans: &[(f64, PointCloud)],
        whole: bool,
        seed: Seed,
        run: &Run<'_>,
    ) -> Result<Self, BloomError> {
        let spec = SegmentSpec::default();
        let mut kept = Vec::new();
        for (day, cloud) in scans {
            let cleaned = bloom::clean(&cloud.points, &CleanSpec::default(), seed, run)?;
            kept.push((*day, cloud.select(&cleaned.kept)));
        }
        let one = |cloud: &PointCloud| -> Result<Vec<ScanOrgan>, BloomError> {
            let organ = bloom::single_organ(&cloud.points, "organ", &spec, run)?;
            Ok(vec![organ.coloured(&cloud.colors)])
        };
        let cut = |cloud: &PointCloud| -> Result<Vec<ScanOrgan>, BloomError> {
            if whole {
                return one(cloud);
            }
            let organs = bloom::organs(&cloud.points, &spec, run)?.into_iter();
            Ok(organs.map(|o| o.coloured(&cloud.colors)).collect())
        };
        let mut stages: Vec<Stage> = kept
            .iter()
            .map(|(day, cloud)| Ok(Stage { day: *day, organs: cut(cloud)? }))
            .collect::<Result<_, BloomError>>()?;
        let single = stages.iter().filter(|s| s.organs.len() == 1).count();
        if single > 0 && single < stages.len() {
            // A scan that is split into stem and leaves cannot be matched with one that is a single organ.
            for (stage, (_, cloud)) in stages.iter_mut().zip(&kept) {
                stage.organs = one(cloud)?;
            }
        }
        for stage in &mut stages {
            stage.organs.retain(|o| o.points.len() >= FEWEST_POINTS);
        }
        for k in 1..stages.len() {
            let (before, now) = stages.split_at_mut(k);
            let Some(now) = now.first_mut() else { continue };
            if now.organs.len() > 1 {
                bloom::name_alike(before, &mut now.organs, DVec3::Y);
            }
        }
        Ok(Self { settled: bloom::settle(&stages, &RegisterSpec::default(), run)? })
    }

    /// Returns the first and the last day.
    pub fn days(&self) -> [f64; 2] {
        let day = |stage: Option<&Stage>| stage.map_or(0.0, |s| s.day);
        [day(self.settled.stages.first()), day(self.settled.stages.last())]
    }

    /// Fits the law by which the organs grow, to 3 days or more.
    ///
    /// # Errors
    /// As [`bloom::fit_stages`].
    pub fn law(&self, name: &str, run: &Run<'_>) -> Result<GrowthLaw, BloomError> {
        bloom::fit_stages(name, &self.settled.stages, &LawSpec::default(), run)
    }

    /// Returns the organs of a day, each with its points and their colours, in the frame of the plant; without a law
    /// everything grows at an even pace.
    ///
    /// # Errors
    /// [`BloomError`].
    pub fn organs(
        &self,
        day: f64,
        law: Option<&GrowthLaw>,
        run: &Run<'_>,
    ) -> Result<Vec<OrganPoints>, BloomError> {
        if let [one] = self.settled.stages.as_slice() {
            return Ok(one.organs.iter().map(OrganPoints::from).collect());
        }
        let [first, last] = self.days();
        let even = GrowthLaw::even(first, last);
        self.settled.day(law.unwrap_or(&even), &MotionSpec::default(), day, run)
    }

    /// Makes the plant of a day: a stem with leaves whose blades are those of the scans.
    ///
    /// # Errors
    /// [`SeedlingError`].
    pub fn plant(
        &self,
        name: &str,
        (day, law): (f64, Option<&GrowthLaw>),
        options: &SeedlingOptions,
        run: &Run<'_>,
    ) -> Result<MadePlant, SeedlingError> {
        let organs = self.organs(day, law, run)?;
        Ok(make_seedling(name, &organs, options, run)?.0)
    }
}
