//! The coordinate system of an LAS file: GeoTIFF keys, or well-known text.

use super::las_parts::Record;

/// A coordinate system as its file names it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct System {
    pub(super) name: String,
    /// The unit of its lengths: the file's name of it, and its length in metres.
    pub(super) unit: Option<(String, f64)>,
    pub(super) is_in_degrees: bool,
}

/// The user id of records that define coordinate systems.
const USER: &str = "LASF_Projection";
/// The record of well-known text.
const WKT: usize = 2112;
/// The record of GeoTIFF keys.
const KEYS: usize = 34735;
/// The record of the texts of GeoTIFF keys.
const TEXTS: usize = 34737;

/// The international foot, metres.
const FOOT: f64 = 0.3048;
/// The foot of surveys in the United States, metres.
const SURVEY_FOOT: f64 = 1200.0 / 3937.0;

/// Units that differ by a smaller share are one: the two feet differ by two millionths.
const SAME_UNIT: f64 = 1e-5;

impl System {
    pub(super) fn from_records(records: &[Record<'_>]) -> Option<Self> {
        let find = |id| records.iter().find(|r| r.is(USER, id)).map(|r| r.data);
        if let Some(text) = find(WKT) {
            let text = String::from_utf8_lossy(text);
            if let Some(system) = Self::from_wkt(text.trim_matches(['\0', ' ', '\n', '\r'])) {
                return Some(system);
            }
        }
        Self::from_keys(find(KEYS)?, find(TEXTS).unwrap_or_default())
    }

    /// The name is the first text in it; the unit is that of the last length before heights are defined, but for those that
    /// ellipsoids have.
    pub(super) fn from_wkt(text: &str) -> Option<Self> {
        let name = text.split('"').nth(1)?.to_owned();
        let plane = ["VERT_CS", "VERTCRS", "VERTICALCRS"].iter().filter_map(|word| text.find(word)).min();
        let plane = &text[..plane.unwrap_or(text.len())];
        let is_in_degrees =
            ["GEOGCS[", "GEOGCRS[", "GEODCRS[", "GEOGRAPHICCRS["].iter().any(|w| plane.contains(w))
                && !["PROJCS[", "PROJCRS[", "PROJECTEDCRS["].iter().any(|w| plane.contains(w));
        let mut unit = None;
        for (at, _) in plane.match_indices("UNIT[\"") {
            let before = &plane[..at];
            let inside_ellipsoid = before.rfind("ELLIPSOID[").is_some_and(|e| !before[e..].contains(']'));
            let mut parts = plane[at + 5..].splitn(3, ',');
            let word = parts.next().unwrap_or_default().trim_matches('"').to_owned();
            let metres = parts.next().and_then(|n| n.split([']', ',']).next()?.trim().parse::<f64>().ok());
            if let Some(metres) = metres.filter(|m| !inside_ellipsoid && *m > 0.0 && m.is_finite())
                && !word.to_ascii_lowercase().contains("degree")
                && !before.ends_with("ANGLE")
                && !before.ends_with("SCALE")
                && !before.ends_with("TIME")
            {
                unit = Some((word, metres));
            }
        }
        Some(Self { name, unit: if is_in_degrees { None } else { unit }, is_in_degrees })
    }

    /// Keys are whole numbers of 16 bits, four each after the first four: key, where its value is, how long, the value.
    fn from_keys(keys: &[u8], texts: &[u8]) -> Option<Self> {
        let words: Vec<u16> = keys.chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]])).collect();
        let rows = || words.get(4..).unwrap_or_default().chunks_exact(4);
        let value = |key: u16| rows().find(|r| r[0] == key && r[1] == 0).map(|r| r[3]);
        let text = |key: u16| {
            let row = rows().find(|r| r[0] == key && usize::from(r[1]) == TEXTS)?;
            let bytes = texts.get(usize::from(row[3])..usize::from(row[3]) + usize::from(row[2]))?;
            Some(String::from_utf8_lossy(bytes).trim_matches(['|', '\0', ' ']).to_owned())
        };
        let code =
            |key| value(key).filter(|code| (1..32767).contains(code)).map(|code| format!("EPSG:{code}"));
        // 1024: what kind of system (2: degrees); 3072: a map; 2048: degrees; 3076: the unit of a map; 1026, 3073: names.
        let is_in_degrees = value(1024) == Some(2);
        let named = text(3073).or_else(|| text(1026)).filter(|name| !name.is_empty());
        let code = if is_in_degrees { code(2048) } else { code(3072) };
        let name = match (code, named) {
            (Some(code), Some(name)) => format!("{code}, {name}"),
            (code, name) => code.or(name)?,
        };
        let unit = match value(3076) {
            Some(9001) => Some(("metre", 1.0)),
            Some(9002) => Some(("foot", FOOT)),
            Some(9003) => Some(("US survey foot", SURVEY_FOOT)),
            _ => None,
        };
        Some(Self { name, unit: unit.map(|(word, metres)| (word.to_owned(), metres)), is_in_degrees })
    }
}

/// Whether two units are the same length.
pub(super) fn is_same_unit(a: f64, b: f64) -> bool {
    (a / b - 1.0).abs() < SAME_UNIT
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn well_known_texts_name_the_system_and_its_unit() {
        let of = |text| System::from_wkt(text).unwrap();
        let feet = r#"COMPD_CS["NAD83 / Oregon + NAVD88",PROJCS["NAD83 / Oregon North (ft)",GEOGCS["NAD83",DATUM["NAD83",SPHEROID["GRS 1980",6378137,298.257]],UNIT["degree",0.0174532925199433]],PROJECTION["x"],UNIT["foot",0.3048]],VERT_CS["NAVD88",VERT_DATUM["x",2005],UNIT["metre",1]]]"#;
        let system = of(feet);
        assert_eq!((system.name.as_str(), system.is_in_degrees), ("NAD83 / Oregon + NAVD88", false));
        assert_eq!(system.unit, Some(("foot".into(), 0.3048)));
        let metres = r#"PROJCRS["ETRS89 / UTM zone 32N",BASEGEOGCRS["ETRS89",DATUM["x",ELLIPSOID["GRS 1980",6378137,298.257,LENGTHUNIT["metre",1]]],PRIMEM["Greenwich",0,ANGLEUNIT["degree",0.0174]]],CS[Cartesian,2],AXIS["e",east],LENGTHUNIT["metre",1]]"#;
        assert_eq!(of(metres).unit, Some(("metre".into(), 1.0)));
        assert!(!of(metres).is_in_degrees);
        let degrees = r#"GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257]],UNIT["degree",0.0174532925199433]]"#;
        assert_eq!((of(degrees).is_in_degrees, of(degrees).unit), (true, None));
        assert_eq!((System::from_wkt(""), System::from_wkt("PROJCS[")), (None, None));
    }

    #[test]
    fn keys_name_the_system_and_its_unit() {
        let of = |rows: &[[u16; 4]]| {
            let words =
                [[1, 1, 0, u16::try_from(rows.len()).unwrap()]].into_iter().chain(rows.iter().copied());
            let bytes: Vec<u8> = words.flatten().flat_map(u16::to_le_bytes).collect();
            System::from_keys(&bytes, b"UTM 32N|rest|")
        };
        let system =
            of(&[[1024, 0, 1, 1], [3072, 0, 1, 25832], [3073, 34737, 8, 0], [3076, 0, 1, 9003]]).unwrap();
        assert_eq!(system.name, "EPSG:25832, UTM 32N");
        assert!(system.unit.is_some_and(|u| is_same_unit(u.1, FOOT) && u.1 > FOOT));
        assert!(of(&[[1024, 0, 1, 2], [2048, 0, 1, 4326]]).unwrap().is_in_degrees);
        assert_eq!((of(&[]), of(&[[3073, 34737, 900, 65000]])), (None, None));
    }
}
