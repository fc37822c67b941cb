//! Plants coloured by the light that they absorb, as the command `light` computes it.

use burgeon::document::DocumentPlant;
use burgeon::light::{LightError, SunPlace, SunPosition};
use burgeon::{
    LIGHT_SCALE, LightOptions, LightSourceError, LightSourceSpec, LightSources, PlaceOnDay, Report, Run,
    Seed, SkyShape, light_stand, shown_plants, stood_plants, without_textures,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::export::made;
use crate::export_preview::ExportPreview;
use crate::view::GUEST;
use crate::{PlantView, WarningView, Workspace, WorkspaceError};

/// Light that is asked for: sky, and sun by its direction or by a place on earth. Null takes the default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LightAsk {
    /// The sky.
    pub sky: Option<SkyShape>,
    /// PAR of the sky on a horizontal surface, W/m2.
    pub diffuse: Option<f64>,
    /// PAR of the sun on a horizontal surface, W/m2.
    pub direct: Option<f64>,
    /// Azimuth of the sun from north over east, and its elevation, degrees.
    pub sun: Option<[f64; 2]>,
    /// Place and day.
    pub place: Option<LightPlace>,
    /// Approximate number of lines of light in each direction.
    pub rays: Option<u32>,
}

/// A place on earth on a day.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LightPlace {
    /// Latitude, degrees north.
    pub latitude: f64,
    /// Longitude, degrees east.
    pub longitude: f64,
    /// Year, month and day.
    pub date: [u32; 3],
    /// The hour by the clock; null: the sum of the day.
    pub hour: Option<f64>,
}

impl LightAsk {
    fn source(&self) -> LightSourceSpec {
        let sun = self.sun.map(|[azimuth_deg, elevation_deg]| SunPosition { azimuth_deg, elevation_deg });
        let place = self.place.map(|there| {
            let LightPlace { latitude, longitude, date, hour } = there;
            let place = SunPlace { latitude_deg: latitude, longitude_deg: longitude, altitude_m: 0.0, date };
            PlaceOnDay { place, hour, zone: None, turbidity: None, daily: hour.is_none() }
        });
        LightSourceSpec { sky: self.sky, diffuse: self.diffuse, direct: self.direct, sun, place }
    }
}

/// The scene in light. Figures that do not apply are null.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct LightView {
    /// W for a moment, MJ for a day.
    pub unit: &'static str,
    /// Light at the end of the scale of colours, absorbed by a square metre of surface.
    pub brightest: f64,
    /// Colours at even shares of it, sRGB.
    pub scale: Vec<[f64; 3]>,
    /// Light on a square metre of a horizontal surface above the plants.
    pub incoming: f64,
    /// That of the sun.
    pub direct: f64,
    /// That of the sky.
    pub diffuse: f64,
    /// Azimuth and elevation of the sun, degrees.
    pub sun: Option<[f64; 2]>,
    /// Hours of sunshine, for a day.
    pub hours: Option<f64>,
    /// Light absorbed by all plants.
    pub absorbed: f64,
    /// Light absorbed by leaves.
    pub leaf_absorbed: f64,
    /// Light absorbed by a square metre of leaves, over that on a horizontal surface.
    pub leaf_share: Option<f64>,
    /// One side of all leaves, square metres.
    pub leaf_area: f64,
    /// Share of the leaf area that is in the sun.
    pub sunlit: Option<f64>,
    /// Warnings.
    pub warnings: Vec<WarningView>,
    /// The coloured meshes of all plants. See [`Workspace::exported_column`].
    pub model: PlantView,
}

impl Workspace {
    /// Computes the light that the shown plants absorb, with the figures of `burgeon light` for the same project. Its
    /// meshes stay until the next preview or [`Workspace::end_preview`].
    ///
    /// # Cost
    /// Linear in triangles, lines of light and directions: seconds.
    ///
    /// # Errors
    /// [`WorkspaceError::Source`], [`WorkspaceError::Light`], or that there is no plant.
    pub fn light(&mut self, asked: &LightAsk, run: &Run<'_>) -> Result<LightView, WorkspaceError> {
        let LightSources { beams, unit, figures: sources } = LightSources::new(&asked.source())?;
        let mut options = LightOptions { unit, ..LightOptions::new(beams) };
        options.spec.lines = asked.rays.unwrap_or(options.spec.lines);
        let document = without_textures(self.editor.document())?;
        let mut scene = self.scene.aside(document.plants());
        let plants = made(&mut scene, &document, None, run)?;
        let ids: Vec<_> = plants.iter().map(|p| DocumentPlant::id(p)).collect();
        let ids: Vec<_> = shown_plants(&document).into_iter().filter(|id| ids.contains(id)).collect();
        let stand = stood_plants(&scene, &document, &ids).ok_or(WorkspaceError::NothingMade)?;
        // The command takes this seed for projects.
        let seed = Seed::new(1);
        let mut report = Report::default();
        let lit = light_stand(&stand, &options, (seed, run), &mut report)?;
        let model = lit.heat_map(document.name(), &stand);
        let view = LightView {
            unit: lit.figures.unit.word(),
            brightest: lit.brightest(),
            scale: LIGHT_SCALE.to_vec(),
            incoming: lit.figures.incoming_per_m2,
            direct: sources.direct_per_m2,
            diffuse: sources.diffuse_per_m2,
            sun: sources.sun_azimuth_deg.zip(sources.sun_elevation_deg).map(|(a, e)| [a, e]),
            hours: sources.day_hours,
            absorbed: lit.figures.absorbed,
            leaf_absorbed: lit.figures.leaf_absorbed,
            leaf_share: lit.figures.leaf_share,
            leaf_area: lit.figures.leaf_area_m2,
            sunlit: lit.figures.sunlit,
            warnings: report.warnings.iter().map(WarningView::from).collect(),
            model: PlantView::from_model(GUEST, &model, &mut self.textures),
        };
        let preview = ExportPreview { models: vec![model], ..ExportPreview::default() };
        self.export_preview = Some(preview);
        Ok(view)
    }
}

impl From<LightSourceError> for WorkspaceError {
    fn from(error: LightSourceError) -> Self {
        Self::Source(error)
    }
}

impl From<LightError> for WorkspaceError {
    fn from(error: LightError) -> Self {
        match error {
            LightError::Cancelled(_) => Self::Cancelled,
            other => Self::Light(other),
        }
    }
}

#[cfg(test)]
mod tests {
    use burgeon::document::SceneCommand;
    use burgeon::glam::DVec3;
    use burgeon::light::Beams;
    use burgeon::{CancelToken, Coded};

    use super::*;
    use crate::{Action, Column, NewMaker};

    const RAYS: u32 = 4_000;

    /// A lily and its copy.
    fn lilies() -> Workspace {
        let mut s = Workspace::default();
        s.act(&Action::Add { name: "a lily".into(), maker: NewMaker::Flower("lily".into()) }).unwrap();
        let lily = s.current().unwrap();
        s.run(SceneCommand::Duplicate(lily, DVec3::X)).unwrap();
        s
    }

    #[test]
    fn the_figures_are_those_of_the_stand() {
        let mut s = lilies();
        let asked = LightAsk { sky: Some(SkyShape::Uniform), rays: Some(RAYS), ..LightAsk::default() };
        let seen = s.light(&asked, &Run::plain()).unwrap();
        let mut scene = burgeon::SceneEvaluator::default();
        let ids = shown_plants(s.document());
        ids.iter().for_each(|id| scene.update(*id, s.document(), &Run::plain()).unwrap());
        let stand = stood_plants(&scene, s.document(), &ids).unwrap();
        let beams = Beams::sky(burgeon::light::SkyKind::Uniform, 100.0).unwrap();
        let mut options = LightOptions::new(beams);
        options.spec.lines = RAYS;
        let lit = light_stand(&stand, &options, (Seed::new(1), &Run::plain()), &mut Report::default());
        let lit = lit.unwrap();
        let wanted = [lit.figures.absorbed, lit.figures.leaf_absorbed, lit.brightest()];
        assert_eq!(
            [seen.absorbed, seen.leaf_absorbed, seen.brightest].map(f64::to_bits),
            wanted.map(f64::to_bits)
        );
        assert_eq!((seen.unit, seen.sun, seen.scale.len()), ("W", None, LIGHT_SCALE.len()));
        let vertices = s.exported_column(0, 0, Column::Positions).len();
        assert!(vertices > 0 && s.exported_column(0, 0, Column::Colors).len() == vertices);
        s.end_preview();
    }

    #[test]
    fn light_that_is_not_there_is_refused_and_a_stop_is_heard() {
        let mut s = lilies();
        let place = |hour| LightPlace { latitude: 48.0, longitude: 11.0, date: [2026, 6, 21], hour };
        let at = |hour| LightAsk { place: Some(place(hour)), rays: Some(RAYS), ..LightAsk::default() };
        let night = s.light(&at(Some(1.0)), &Run::plain()).expect_err("the sun is down");
        assert_eq!(night.details().code, "sun-below");
        let day = s.light(&at(None), &Run::plain()).unwrap();
        assert!(day.unit == "MJ" && day.hours.is_some_and(|h| h > 15.0), "{:?}", day.hours);
        let cancel = CancelToken::new();
        cancel.cancel();
        let stopped = Run { cancel: &cancel, ..Run::plain() };
        assert!(matches!(s.light(&LightAsk::default(), &stopped), Err(WorkspaceError::Cancelled)));
        assert!(matches!(
            Workspace::default().light(&LightAsk::default(), &Run::plain()),
            Err(WorkspaceError::NothingMade)
        ));
    }
}
