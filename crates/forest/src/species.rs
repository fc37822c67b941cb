//! The figures of all species, one row a preset.
//!
//! | column | meaning |
//! |---|---|
//! | `top_m`, `thick_m` | height and diameter that old trees come to: what floras say, rounded |
//! | `free`, `stand` | metres of height for each metre of diameter of a young stem, free-standing and in a closed stand |
//! | `dbh_50_m` | diameter of a free-standing tree after 50 years on a good site |
//! | `crown` | crown of a free-standing tree |
//! | `light` | light demand: 0 grows in deep shade, 1 in full light alone |
//! | `life` | years that one tree in a hundred lives |
//! | `spread_m` | mean distance from a tree to its seedlings |
//!
//! The columns `crown` of Hasenauer are published; the others are general forms ([`Allometry`](crate::Allometry)) with
//! figures chosen by us, and have the wide intervals of their group.

use crate::allometry::{Allometry, Crown, FunctionalGroup, Stem};

/// Defines a row for a tree.
macro_rules! tree {
    ($preset:literal, $latin:literal, [$($name:literal),*], $group:ident, top $top:literal, thick $thick:literal,
     free $free:literal, stand $stand:literal, dbh_50 $dbh_50:literal, crown $crown:expr, light $light:literal,
     life $life:literal, spread $spread:literal) => {
        Allometry {
            preset: $preset, latin: $latin, names: &[$($name),*], group: FunctionalGroup::$group, top_m: $top,
            stem: Some(Stem { thick_m: $thick, free: $free, stand: $stand, dbh_50_m: $dbh_50, crown: $crown }),
            width_of_height: 0.0, light: $light, life_years: $life, spread_m: $spread,
        }
    };
}

/// Defines a row for a plant without a trunk to measure: its width is a share of its height.
macro_rules! clump {
    ($preset:literal, $latin:literal, [$($name:literal),*], $group:ident, top $top:literal, wide $wide:literal,
     light $light:literal, life $life:literal, spread $spread:literal) => {
        Allometry {
            preset: $preset, latin: $latin, names: &[$($name),*], group: FunctionalGroup::$group, top_m: $top, stem: None,
            width_of_height: $wide, light: $light, life_years: $life, spread_m: $spread,
        }
    };
}

/// Returns the equation of Hasenauer (1997) for open-grown trees in Austria: `ln(width / m) = b0 + b1 ln(dbh / cm)`,
/// with the variance of its residuals.
const fn hasenauer(b0: f64, b1: f64, variance: f64) -> Crown {
    Crown { b0, b1, variance, is_published: true }
}

/// Returns an equation of the same form with figures chosen by us, for kinds that Hasenauer did not measure.
const fn general(b0: f64, b1: f64, variance: f64) -> Crown {
    Crown { b0, b1, variance, is_published: false }
}

/// Hasenauer's equation for other broadleaves.
const OTHER_BROADLEAF: Crown = hasenauer(0.1783, 0.5665, 0.025);
/// Hasenauer's equation for oak.
const OAK: Crown = hasenauer(-0.3973, 0.7328, 0.038);
/// Variance of logarithms if only the form is known: one tree in twenty is more than 2.2 times as wide, or less than
/// 1 / 2.2.
const WIDE: f64 = 0.16;
/// Columnar and spindle-shaped cultivars.
const NARROW: Crown = general(-1.0, 0.55, WIDE);
/// Heads of fronds, which hardly grow with the stem.
const FRONDS: Crown = general(1.0, 0.2, WIDE);
/// Crowns of fruit trees and of others that fork low, and flat tops.
const LOW: Crown = general(0.25, 0.62, WIDE);
/// Crowns of conifers that Hasenauer did not measure.
const CONIFER: Crown = general(-0.3, 0.65, WIDE);

/// All species, in order of the presets' words.
#[rustfmt::skip]
pub(crate) const SPECIES: &[Allometry] = &[
    tree!("acacia", "Vachellia tortilis", ["umbrella thorn", "acacia tortilis"], Broadleaf, top 18.0, thick 0.9, free 26.0, stand 50.0, dbh_50 0.3, crown general(0.6, 0.6, WIDE), light 0.95, life 150.0, spread 20.0),
    clump!("agave", "Agave americana", ["century plant"], Herb, top 1.8, wide 1.5, light 1.0, life 30.0, spread 2.0),
    tree!("alder", "Alnus glutinosa", ["black alder", "common alder"], Broadleaf, top 30.0, thick 0.9, free 55.0, stand 105.0, dbh_50 0.4, crown OTHER_BROADLEAF, light 0.7, life 200.0, spread 30.0),
    tree!("apple", "Malus domestica", ["malus", "crab apple", "malus sylvestris"], Broadleaf, top 10.0, thick 0.6, free 28.0, stand 60.0, dbh_50 0.3, crown LOW, light 0.8, life 100.0, spread 15.0),
    tree!("ash", "Fraxinus excelsior", ["european ash", "common ash"], Broadleaf, top 40.0, thick 1.6, free 45.0, stand 115.0, dbh_50 0.45, crown hasenauer(0.1366, 0.6183, 0.051), light 0.6, life 350.0, spread 40.0),
    clump!("bamboo", "Bambusa vulgaris", ["common bamboo"], Shrub, top 15.0, wide 0.4, light 0.7, life 60.0, spread 3.0),
    clump!("banana", "Musa x paradisiaca", ["plantain"], Herb, top 5.0, wide 0.8, light 0.9, life 10.0, spread 1.5),
    tree!("baobab", "Adansonia digitata", ["african baobab"], Broadleaf, top 24.0, thick 8.0, free 9.0, stand 18.0, dbh_50 1.0, crown general(0.0, 0.5, WIDE), light 0.95, life 1000.0, spread 40.0),
    tree!("beech", "Fagus sylvatica", ["european beech", "common beech"], Broadleaf, top 42.0, thick 1.7, free 42.0, stand 115.0, dbh_50 0.42, crown hasenauer(0.2662, 0.6072, 0.058), light 0.1, life 400.0, spread 15.0),
    tree!("birch", "Betula pendula", ["silver birch"], Broadleaf, top 28.0, thick 0.7, free 55.0, stand 110.0, dbh_50 0.37, crown OTHER_BROADLEAF, light 0.95, life 180.0, spread 60.0),
    clump!("boston-ivy", "Parthenocissus tricuspidata", ["japanese creeper"], Shrub, top 15.0, wide 0.7, light 0.3, life 80.0, spread 5.0),
    tree!("cedar", "Cedrus libani", ["cedar of lebanon", "lebanon cedar"], Conifer, top 38.0, thick 2.2, free 32.0, stand 85.0, dbh_50 0.5, crown general(0.0, 0.65, WIDE), light 0.7, life 600.0, spread 30.0),
    tree!("cherry", "Prunus serrulata", ["japanese cherry", "japanese flowering cherry", "prunus avium", "wild cherry"], Broadleaf, top 14.0, thick 0.7, free 30.0, stand 70.0, dbh_50 0.36, crown LOW, light 0.7, life 90.0, spread 20.0),
    tree!("chinese-fir", "Cunninghamia lanceolata", ["cunninghamia"], Conifer, top 40.0, thick 1.6, free 60.0, stand 105.0, dbh_50 0.45, crown CONIFER, light 0.5, life 300.0, spread 30.0),
    tree!("cypress", "Cupressus sempervirens", ["italian cypress", "mediterranean cypress"], Conifer, top 30.0, thick 0.9, free 60.0, stand 80.0, dbh_50 0.36, crown NARROW, light 0.8, life 400.0, spread 20.0),
    tree!("date-palm", "Phoenix dactylifera", ["true date palm"], Palm, top 25.0, thick 0.6, free 30.0, stand 40.0, dbh_50 0.42, crown FRONDS, light 1.0, life 150.0, spread 10.0),
    tree!("dead-oak", "Quercus robur", ["dead tree", "snag"], Broadleaf, top 38.0, thick 2.2, free 40.0, stand 110.0, dbh_50 0.45, crown OAK, light 0.6, life 500.0, spread 25.0),
    tree!("elm", "Ulmus glabra", ["wych elm", "scots elm"], Broadleaf, top 38.0, thick 1.6, free 40.0, stand 110.0, dbh_50 0.46, crown OTHER_BROADLEAF, light 0.4, life 450.0, spread 40.0),
    tree!("eucalyptus", "Eucalyptus globulus", ["blue gum", "tasmanian blue gum"], Broadleaf, top 60.0, thick 2.0, free 60.0, stand 125.0, dbh_50 0.8, crown general(-0.1, 0.6, WIDE), light 0.9, life 250.0, spread 30.0),
    tree!("fig", "Ficus carica", ["common fig"], Broadleaf, top 9.0, thick 0.5, free 30.0, stand 55.0, dbh_50 0.3, crown LOW, light 0.8, life 100.0, spread 15.0),
    tree!("ginkgo", "Ginkgo biloba", ["maidenhair tree"], Broadleaf, top 38.0, thick 1.8, free 42.0, stand 95.0, dbh_50 0.38, crown general(-0.1, 0.6, WIDE), light 0.8, life 800.0, spread 15.0),
    clump!("grass", "Cenchrus setaceus", ["fountain grass", "pennisetum setaceum"], Herb, top 1.0, wide 1.0, light 1.0, life 8.0, spread 2.0),
    clump!("hazel", "Corylus avellana", ["common hazel"], Shrub, top 7.0, wide 0.9, light 0.3, life 70.0, spread 10.0),
    tree!("juniper", "Juniperus communis", ["common juniper"], Conifer, top 12.0, thick 0.4, free 45.0, stand 60.0, dbh_50 0.14, crown general(-0.7, 0.5, WIDE), light 0.95, life 200.0, spread 15.0),
    tree!("larch", "Larix decidua", ["european larch"], Conifer, top 45.0, thick 1.6, free 55.0, stand 105.0, dbh_50 0.45, crown hasenauer(-0.3396, 0.6823, 0.035), light 0.95, life 800.0, spread 40.0),
    clump!("lavender", "Lavandula angustifolia", ["english lavender"], Herb, top 0.8, wide 1.1, light 1.0, life 15.0, spread 1.0),
    tree!("lime", "Tilia cordata", ["small-leaved lime", "small leaved lime", "littleleaf linden", "linden"], Broadleaf, top 36.0, thick 1.8, free 42.0, stand 110.0, dbh_50 0.45, crown OTHER_BROADLEAF, light 0.25, life 700.0, spread 25.0),
    tree!("magnolia-tree", "Magnolia x soulangeana", ["saucer magnolia", "magnolia"], Broadleaf, top 9.0, thick 0.5, free 28.0, stand 55.0, dbh_50 0.28, crown LOW, light 0.6, life 120.0, spread 10.0),
    clump!("maize", "Zea mays", ["corn"], Herb, top 2.4, wide 0.4, light 1.0, life 1.0, spread 0.5),
    tree!("mangrove", "Rhizophora mangle", ["red mangrove"], Broadleaf, top 20.0, thick 0.6, free 45.0, stand 100.0, dbh_50 0.3, crown general(0.1, 0.6, WIDE), light 0.7, life 150.0, spread 8.0),
    tree!("maple", "Acer platanoides", ["norway maple"], Broadleaf, top 30.0, thick 1.2, free 42.0, stand 110.0, dbh_50 0.45, crown hasenauer(0.418, 0.5285, 0.025), light 0.3, life 300.0, spread 40.0),
    tree!("oak", "Quercus robur", ["english oak", "pedunculate oak", "common oak"], Broadleaf, top 38.0, thick 2.2, free 40.0, stand 110.0, dbh_50 0.45, crown OAK, light 0.6, life 800.0, spread 25.0),
    tree!("oak-colonization", "Quercus robur", ["oak by colonization"], Broadleaf, top 38.0, thick 2.2, free 40.0, stand 110.0, dbh_50 0.45, crown OAK, light 0.6, life 500.0, spread 25.0),
    tree!("oak-lsystem", "Quercus robur", ["oak by rules"], Broadleaf, top 38.0, thick 2.2, free 40.0, stand 110.0, dbh_50 0.45, crown OAK, light 0.6, life 500.0, spread 25.0),
    tree!("olive", "Olea europaea", ["common olive"], Broadleaf, top 12.0, thick 1.5, free 20.0, stand 45.0, dbh_50 0.3, crown LOW, light 0.9, life 600.0, spread 15.0),
    tree!("palm", "Cocos nucifera", ["coconut palm", "coconut"], Palm, top 28.0, thick 0.45, free 50.0, stand 65.0, dbh_50 0.3, crown FRONDS, light 0.95, life 90.0, spread 8.0),
    tree!("pine", "Pinus sylvestris", ["scots pine", "scotch pine"], Conifer, top 36.0, thick 1.1, free 48.0, stand 112.0, dbh_50 0.4, crown hasenauer(-0.1797, 0.6267, 0.037), light 0.85, life 600.0, spread 40.0),
    tree!("plane-tree", "Platanus x hispanica", ["london plane", "plane", "platanus x acerifolia", "platanus acerifolia", "platanus hispanica"], Broadleaf, top 40.0, thick 2.2, free 40.0, stand 100.0, dbh_50 0.6, crown general(0.1, 0.66, WIDE), light 0.7, life 400.0, spread 40.0),
    tree!("plum", "Prunus cerasifera", ["cherry plum", "myrobalan"], Broadleaf, top 9.0, thick 0.5, free 28.0, stand 55.0, dbh_50 0.3, crown LOW, light 0.8, life 80.0, spread 15.0),
    tree!("poplar", "Populus nigra 'Italica'", ["lombardy poplar", "black poplar", "populus nigra"], Broadleaf, top 35.0, thick 1.4, free 60.0, stand 100.0, dbh_50 0.6, crown NARROW, light 0.95, life 120.0, spread 60.0),
    clump!("reed", "Phragmites australis", ["common reed"], Herb, top 3.0, wide 0.3, light 0.9, life 20.0, spread 2.0),
    clump!("rose", "Rosa gallica", ["shrub rose", "french rose"], Shrub, top 1.5, wide 1.0, light 0.7, life 30.0, spread 3.0),
    clump!("saguaro", "Carnegiea gigantea", ["giant cactus"], Shrub, top 14.0, wide 0.25, light 1.0, life 200.0, spread 10.0),
    tree!("spruce", "Picea abies", ["norway spruce", "european spruce"], Conifer, top 46.0, thick 1.5, free 58.0, stand 105.0, dbh_50 0.45, crown hasenauer(-0.3232, 0.6441, 0.026), light 0.3, life 600.0, spread 30.0),
    tree!("terminalia", "Terminalia mantaly", ["madagascar almond"], Broadleaf, top 18.0, thick 0.6, free 45.0, stand 80.0, dbh_50 0.4, crown general(0.2, 0.6, WIDE), light 0.8, life 80.0, spread 15.0),
    tree!("tree-fern", "Dicksonia antarctica", ["soft tree fern"], Palm, top 9.0, thick 0.5, free 10.0, stand 15.0, dbh_50 0.3, crown FRONDS, light 0.1, life 200.0, spread 10.0),
    tree!("umbrella-pine", "Pinus pinea", ["stone pine", "italian stone pine"], Conifer, top 25.0, thick 1.2, free 32.0, stand 75.0, dbh_50 0.45, crown general(0.1, 0.65, WIDE), light 0.9, life 250.0, spread 15.0),
    clump!("wheat", "Triticum aestivum", ["bread wheat"], Herb, top 1.0, wide 0.2, light 1.0, life 1.0, spread 0.3),
    tree!("willow", "Salix babylonica", ["weeping willow"], Broadleaf, top 18.0, thick 1.0, free 30.0, stand 65.0, dbh_50 0.6, crown LOW, light 0.9, life 80.0, spread 60.0),
    tree!("yew", "Taxus baccata", ["english yew", "common yew"], Conifer, top 20.0, thick 1.6, free 26.0, stand 60.0, dbh_50 0.3, crown general(0.0, 0.62, WIDE), light 0.0, life 1000.0, spread 15.0),
];
