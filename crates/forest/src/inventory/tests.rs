use base::{Budget, CancelToken, Run};
use proptest::prelude::*;

use super::*;
use crate::Setting;

fn read(text: &str) -> Result<(Stand, InventoryReport), InventoryError> {
    read_inventory(text.as_bytes(), &InventorySpec::default(), &Run::plain())
}

fn said(text: &str) -> String {
    read(text).map_or_else(|e| e.to_string(), |(stand, _)| panic!("it was taken: {stand:?}"))
}

#[test]
fn given_figures_stay_and_missing_ones_are_filled() {
    let (stand, report) = read(
        "\u{feff}Tree;X;Y;Species;Height (m);dbh_mm;crown_cm;age\n\
         1;0,5;-2,25;\"oak\";17,5;415;1120;80\n2;20;3;Picea abies;;;;\n3;40;3;spruce;0;NA;-;12\n",
    )
    .expect("sound");
    assert!(stand.validate().next().is_none());
    let [oak, spruce, young] = &stand.trees[..] else { panic!("{stand:?}") };
    assert_eq!((oak.foot_m, oak.height_m, oak.dbh_m), (DVec3::new(0.5, 0.0, 2.25), 17.5, 0.415));
    assert_eq!((oak.crown_width_m, oak.age_years, oak.row), (11.2, 80.0, 1));
    assert!([Figure::Height, Figure::Dbh, Figure::CrownWidth, Figure::Age].iter().all(|f| oak.given.has(*f)));
    assert_eq!((spruce.given, young.given), (Given::default(), Given::default().with(Figure::Age)));
    assert!(young.height_m < spruce.height_m && young.dbh_m > 0.02);
    assert_eq!((report.height.given, report.height.filled, report.age.given), (1, 2, 2));
    assert!(report.height.mean_log_interval > 0.3, "{report:?}");
    let codes: Vec<_> = report.report.warnings.iter().map(|w| w.code).collect();
    assert_eq!(codes, ["inventory-zeros", "inventory-sizeless"]);
    assert_eq!(stand.species, ["oak", "spruce"]);
}

#[test]
fn separators_quotes_and_units() {
    for text in [
        "x,y,species,dbh (cm)\n1,2,\"oak\",30\n",
        "x\ty\tspecies\tdbh (cm)\n1\t2\toak\t30\n",
        "x|y|species|dbh (cm)\n1|2|oak|30\n",
        "species,remark,x,y,circumference_cm\n\"oak\",\"old, \"\"fine\"\"\nof two lines\",1,2,94.24777960769379\n",
        "x,y,species,dbh\n1,2,oak,30 cm\n",
        "x,y,species,dbh\n1,2,oak,0.3\n",
        "x,y,species,dbh\n1,2,oak,30\n",
        "x_cm,y_m,species,DBH [in]\n100,2,oak,11.811023622047244\n",
    ] {
        let (stand, _) = read(text).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_eq!(stand.trees.len(), 1);
        assert!((stand.trees[0].dbh_m - 0.3).abs() < 1e-12, "{text}: {:?}", stand.trees[0]);
        assert_eq!(stand.trees[0].foot_m, DVec3::new(1.0, 0.0, -2.0));
    }
}

#[test]
fn bad_input_names_row_column_and_the_way_out() {
    let head = "x,y,species,height\n0,0,oak,12\n";
    for (row, words) in [
        ("5,5,oak,1200\n", "row 2, column `height`: 1200 m is no height"),
        ("5,5,oak,-3\n", "row 2, column `height`: -3 is negative"),
        ("5,5,oak,tall\n", "row 2, column `height`: `tall` is no number"),
        ("5,5,oak,inf\n", "is no number that can be measured"),
        ("5,5,oka,12\n", "row 2, column `species`: there is no species `oka`; is `oak` meant?"),
        ("5,5,,12\n", "row 2, column `species`: there is no species; name it"),
        ("5,,oak,12\n", "row 2, column `y`: there is no place"),
        ("1e300,5,oak,12\n", "row 2, column `x`"),
        ("5,5,oak\n", "row 2: it has 3 fields, the header has 4"),
    ] {
        let message = said(&format!("{head}{row}"));
        assert!(message.contains(words), "{row}: {message}");
        // Left out on request, and counted.
        let skip = InventorySpec { bad_rows: BadRows::Skip, ..InventorySpec::default() };
        let (stand, report) =
            read_inventory(format!("{head}{row}").as_bytes(), &skip, &Run::plain()).expect("skips");
        assert_eq!((stand.trees.len(), report.rows, report.skipped), (1, 2, 1), "{row}");
        assert!(
            report.report.warnings[0].message.starts_with("1 rows were left out, the first because: row 2")
        );
    }
    for (text, words) in [
        ("", "no trees"),
        ("x,y,species\n", "no trees"),
        ("a,b,species\n1,2,oak\n", "no columns say where trees stand"),
        ("estin,y,species\n1,2,oak\n", "no columns say where"),
        ("x,y\n1,2\n", "no column names the species"),
        ("lon,lat,species\n11.5,48.1,oak\n", "say how they become metres"),
        ("x,y,species\n11.573211,48.137214,oak\n11.573302,48.137107,oak\n", "look like degrees"),
        (
            "x,y,species,dbh\n1,2,oak,0.4\n9,2,oak,0.5\n20,2,oak,45\n",
            "neither all metres nor all centimetres",
        ),
        ("{\"type\":\"FeatureCollection\"}", "no `features`"),
        (
            "{\"features\":[{\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[]}}]}",
            "feature 1 is a Polygon",
        ),
        ("{\"features\":[", "no sound GeoJSON"),
        ("\u{0}\u{0}", "not UTF-8"),
    ] {
        let message = said(text);
        assert!(message.contains(words), "{text}: {message}");
    }
    assert!(read_inventory(&[0xff, 0xfe, 0x31], &InventorySpec::default(), &Run::plain()).is_err());
}

#[test]
fn degrees_become_metres_by_a_stated_projection() {
    let text = "lon,lat,species\n11.0,48.0,oak\n11.001,48.0,oak\n11.0,48.001,oak\n";
    for crs in ["local", "utm", "utm32N"] {
        let spec = InventorySpec { crs: Crs::from_word(crs), ..InventorySpec::default() };
        let (stand, _) = read_inventory(text.as_bytes(), &spec, &Run::plain()).expect("sound");
        let [a, b, c] = [0, 1, 2].map(|k| stand.trees[k].foot_m);
        // A thousandth of a degree: 74.6 m of longitude at 48 degrees, 111.2 m of latitude; UTM is shorter by 1 in
        // 2,500.
        assert!(((b - a).length() - 74.62).abs() < 0.1, "{crs}: {}", (b - a).length());
        assert!(((c - a).length() - 111.19).abs() < 0.1, "{crs}: {}", (c - a).length());
        assert!(c.z < a.z && b.x > a.x, "north is -Z, east is +X");
    }
    let swapped = "lon,lat,species\n48.1,111.5,oak\n";
    let spec = InventorySpec { crs: Some(Crs::Local), ..InventorySpec::default() };
    let fault = read_inventory(swapped.as_bytes(), &spec, &Run::plain()).expect_err("no latitude");
    assert!(fault.to_string().contains("swapped"), "{fault}");
    let far = "lon,lat,species\n-60,10,oak\n60,10,oak\n";
    let fault = read_inventory(far.as_bytes(), &spec, &Run::plain()).expect_err("too far");
    assert!(matches!(fault, InventoryError::Span(..)), "{fault}");
}

#[test]
fn geojson_of_points() {
    let text = r#"{"type":"FeatureCollection","features":[
      {"type":"Feature","geometry":{"type":"Point","coordinates":[11.0,48.0,520.0]},
       "properties":{"Species":"Tilia cordata","height_m":18.5,"planted":"1970","id":7}},
      {"type":"Feature","geometry":{"type":"MultiPoint","coordinates":[[11.001,48.0],[11.002,48.0]]},
       "properties":{"Species":"beech","dbh (cm)":40,"alive":true}}]}"#;
    let spec = InventorySpec { crs: Some(Crs::Local), year: Some(2026), ..InventorySpec::default() };
    let (stand, report) = read_inventory(text.as_bytes(), &spec, &Run::plain()).expect("sound");
    assert_eq!((stand.trees.len(), report.rows), (3, 3));
    assert_eq!((stand.trees[0].height_m, stand.trees[0].age_years), (18.5, 56.0));
    assert_eq!((stand.trees[2].dbh_m, stand.trees[2].row), (0.4, 3));
    assert!(said(text).contains("say how they become metres"), "GeoJSON is in degrees");
}

#[test]
fn crowds_duplicates_and_touching_trunks() {
    let one_place = "x,y,species\n".to_owned() + &"3,4,oak\n".repeat(5000);
    assert!(
        said(&one_place).contains("5000 of 5000 rows stand within one metre of 3, 4"),
        "{}",
        said(&one_place)
    );
    let (stand, report) =
        read("x,y,species,dbh_m\n0,0,oak,1\n0,0,oak,1\n0.6,0,oak,0.5\n9,0,oak,0.5\n").expect("sound");
    assert_eq!((stand.trees.len(), report.duplicates, report.touching), (4, 1, 2));
    let codes: Vec<_> = report.report.warnings.iter().map(|w| w.code).collect();
    assert_eq!(codes, ["inventory-duplicates", "inventory-touching"]);
}

#[test]
fn too_many_rows_and_a_change_of_mind() {
    let text = "x,y,species\n".to_owned() + &(0..20).map(|k| format!("{k},0,oak\n")).collect::<String>();
    let budget = Budget { times: 1e-6, ..Budget::default() };
    let small = Run { budget, ..Run::plain() };
    let fault = read_inventory(text.as_bytes(), &InventorySpec::default(), &small).expect_err("too many");
    assert!(fault.to_string().contains("11 trees of a stand are more than the limit of 10"), "{fault}");
    let cancel = CancelToken::new();
    cancel.cancel();
    let stopped = Run { cancel: &cancel, ..Run::plain() };
    let fault = read_inventory(text.as_bytes(), &InventorySpec::default(), &stopped).expect_err("stopped");
    assert!(matches!(fault, InventoryError::Cancelled(_)));
}

#[test]
fn species_by_genus_or_on_request() {
    let text = "x,y,latin,name\n0,0,Quercus petraea,\n9,0,Koelreuteria paniculata,tree 12\n";
    assert!(said(text).contains("row 2, column `latin`"), "{}", said(text));
    let spec = InventorySpec { species: Some("lime".into()), ..InventorySpec::default() };
    let (stand, report) = read_inventory(text.as_bytes(), &spec, &Run::plain()).expect("sound");
    assert_eq!(stand.species, ["oak", "lime"]);
    let messages: Vec<_> = report.report.warnings.iter().map(|w| w.message.as_str()).collect();
    assert!(
        messages[0].contains("`Quercus petraea` (1 trees) has no figures of its own: taken as `oak`"),
        "{messages:?}"
    );
    assert!(
        messages[1].contains("1 trees of unknown species, the first `Koelreuteria paniculata`"),
        "{messages:?}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Counts equal the inventory, given figures are kept to the bit, and every tree is sound.
    #[test]
    fn stands_have_the_trees_of_their_inventory(
        rows in prop::collection::vec((0.0..900.0_f64, 0.0..900.0_f64, prop::option::of(0.2..60.0_f64), prop::option::of(0.004..3.0_f64),
            prop::option::of(0.2..40.0_f64), prop::option::of(0.0..900.0_f64), 0..50_usize), 1..40),
        is_stand in any::<bool>(),
    ) {
        let number = |v: Option<f64>| v.map(|v| v.to_string()).unwrap_or_default();
        let mut text = String::from("x,y,species,height_m,dbh_m,crown_m,age\n");
        for (x, y, h, d, c, a, s) in &rows {
            let species = Allometry::all()[s % Allometry::all().len()].preset;
            text += &format!("{x},{y},{species},{},{},{},{}\n", number(*h), number(*d), number(*c), number(*a));
        }
        let setting = if is_stand { Setting::Stand } else { Setting::Free };
        // Three rows in a hundred metres are not degrees, but random numbers have as many decimals.
        let spec = InventorySpec { setting, crs: Some(Crs::Metres), ..InventorySpec::default() };
        let (stand, report) = read_inventory(text.as_bytes(), &spec, &Run::plain()).unwrap();
        prop_assert_eq!(stand.trees.len(), rows.len());
        prop_assert_eq!(report.height.given + report.height.filled, u32::try_from(stand.trees.len()).unwrap());
        prop_assert_eq!(stand.validate().next(), None);
        for (tree, (.., h, d, c, a, _)) in stand.trees.iter().zip(&rows) {
            prop_assert!(h.is_none_or(|h| h == tree.height_m) && c.is_none_or(|c| c == tree.crown_width_m));
            prop_assert!(d.is_none_or(|d| d == tree.dbh_m) && a.is_none_or(|a| a == tree.age_years));
        }
    }

    /// No bytes cause a panic.
    #[test]
    fn any_text_is_taken_or_refused(text in "[xylonatspecidbh,;\t\"0-9.\\-\n{}\\[\\]: ]{0,200}") {
        let _ = read(&text);
        let _ = read(&format!("x,y,species,height\n{text}"));
        let _ = read(&format!("{{\"features\":[{text}"));
    }
}
