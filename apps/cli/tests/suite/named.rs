//! Files that files name: below the folder of the file that names them, or with --trust-paths. No pipe is waited for,
//! no device read.
#![expect(clippy::unwrap_used, reason = "tests")]

use crate::tools;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::Value;
use tools::{FLOWER, bad, burgeon, folder, good, status};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl wood\nf 1/1 2/2 3/3\n";
/// Remedy in every refusal.
const WAY_OUT: &str = "allow it with --trust-paths";

/// Writes a glTF of a triangle whose buffer is a file.
fn gltf(uri: &str) -> String {
    let head = r#"{"asset": {"version": "2.0"}, "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0"#;
    format!("{head}, \"buffers\": [{{\"uri\": {}, \"byteLength\": 36}}]}}", Value::from(uri))
}

fn triangle() -> Vec<u8> {
    [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// Makes `secret.bin`, `secret.png` and, in the folder `in`, `p.bin` and `t.png` of the same content.
fn place(test: &str) -> std::path::PathBuf {
    let dir = folder(test);
    fs::create_dir_all(dir.join("in/sub")).unwrap();
    for name in ["secret.bin", "in/p.bin"] {
        fs::write(dir.join(name), triangle()).unwrap();
    }
    fs::write(dir.join("box.obj"), TRIANGLE).unwrap();
    good(&dir, &["render", "box.obj", "-o", "secret.png", "--size", "8x8", "-q"]);
    fs::copy(dir.join("secret.png"), dir.join("in/t.png")).unwrap();
    dir
}

/// Checks that the command is refused in one line with all parts, and works with --trust-paths.
fn needs_trust(dir: &Path, args: &[&str], parts: &[&str]) {
    let line = bad(dir, args);
    assert!(parts.iter().chain([&WAY_OUT]).all(|p| line.contains(p)), "{args:?} said {line}");
    good(dir, &[args, &["--trust-paths"]].concat());
}

/// Checks that the command is refused in one line with all parts, with --trust-paths, too; and soon.
fn never(dir: &Path, args: &[&str], parts: &[&str]) {
    let start = Instant::now();
    let line = bad(dir, &[args, &["--trust-paths"]].concat());
    assert!(parts.iter().all(|p| line.contains(p)), "{args:?} said {line}");
    assert!(start.elapsed() < Duration::from_secs(20), "{args:?} took {:?}", start.elapsed());
}

fn materials_of(dir: &Path, model: &str, more: &[&str]) -> Value {
    let said = good(dir, &[&["info", model, "--json"][..], more].concat());
    serde_json::from_str::<Value>(&said).unwrap()["model"]["materials"].clone()
}

#[test]
fn buffers_of_a_gltf_lie_below_it() {
    let dir = place("named-buffers");
    let secret = dir.join("secret.bin");
    let write = |uri: &str| fs::write(dir.join("in/a.gltf"), gltf(uri)).unwrap();
    for uri in ["p.bin", "./p.bin", "sub/../p.bin", "sub\\..\\p.bin", "%70.bin"] {
        write(uri);
        good(&dir, &["info", "in/a.gltf"]);
    }
    // A name may have a percent sign, and a URI a space.
    fs::copy(dir.join("in/p.bin"), dir.join("in/a b%20c.bin")).unwrap();
    for uri in ["a b%20c.bin", "a%20b%2520c.bin"] {
        write(uri);
        good(&dir, &["info", "in/a.gltf"]);
    }
    let outside = ["../secret.bin", "..\\secret.bin", "%2e%2e%2Fsecret.bin", "sub/../../secret.bin"];
    for uri in outside.into_iter().chain(secret.to_str()) {
        write(uri);
        needs_trust(
            &dir,
            &["info", "in/a.gltf"],
            &["in/a.gltf: names", "secret.bin", "not below its folder"],
        );
    }
    write("none.bin");
    let line = bad(&dir, &["info", "in/a.gltf"]);
    assert!(line.contains("was not found") && !line.contains("trust"), "{line}");
    write("large.bin");
    fs::File::create(dir.join("in/large.bin")).unwrap().set_len(257 << 20).unwrap();
    never(&dir, &["info", "in/a.gltf"], &["\"large.bin\"", "larger than 256 MiB"]);
    write("sub");
    never(&dir, &["info", "in/a.gltf"], &["\"sub\"", "a folder"]);
}

#[test]
fn materials_and_textures_lie_below_who_names_them() {
    let dir = place("named-materials");
    let write = |name: &str, text: &str| fs::write(dir.join(name), text).unwrap();
    let library = |texture: &str| format!("newmtl wood\nKd 1 0 0\nmap_Kd {texture}\n");
    let has_texture = |more: &[&str]| !materials_of(&dir, "in/a.obj", more)[0]["texture"].is_null();
    write("in/a.obj", &format!("mtllib sub\\a.mtl\n{TRIANGLE}"));
    // Next to the file of materials, with any separator of folders; or next to the model, as some programs write it.
    fs::rename(dir.join("in/t.png"), dir.join("in/sub/t.png")).unwrap();
    write("in/sub/a.mtl", &library("t.png"));
    assert!(has_texture(&[]), "beside the file of materials");
    write("in/a.mtl", &library("sub\\t.png"));
    write("in/a.obj", &format!("mtllib a.mtl\n{TRIANGLE}"));
    assert!(has_texture(&[]), "below it");
    write("in/a.obj", &format!("mtllib sub/a.mtl\n{TRIANGLE}"));
    write("in/sub/a.mtl", &library("sub/t.png"));
    assert!(has_texture(&[]), "beside the model");
    write("in/sub/a.mtl", &library("gone.png"));
    assert!(!has_texture(&[]), "a texture that is not there is left out");
    // Within the model's folder, but not within that of the file of materials.
    fs::copy(dir.join("secret.png"), dir.join("in/t.png")).unwrap();
    for texture in ["../t.png", "..\\..\\secret.png"] {
        write("in/sub/a.mtl", &library(texture));
        needs_trust(&dir, &["info", "in/a.obj"], &["in/sub/a.mtl: names", "not below its folder"]);
        assert!(has_texture(&["--trust-paths"]), "{texture}");
    }
    write("other.mtl", "newmtl wood\n# burgeon double-sided\n");
    for name in ["../other.mtl", "sub/../../other.mtl", dir.join("other.mtl").to_str().unwrap()] {
        write("in/a.obj", &format!("mtllib {name}\n{TRIANGLE}"));
        needs_trust(&dir, &["info", "in/a.obj"], &["in/a.obj: names", "other.mtl"]);
    }
    assert_eq!(materials_of(&dir, "in/a.obj", &["--trust-paths"])[0]["double_sided"], true);
}

/// It was once read anew for each line: 51 s.
#[test]
fn a_library_is_read_once_however_often_it_is_named() {
    let dir = folder("named-often");
    fs::write(dir.join("a.mtl"), "newmtl wood\n# burgeon double-sided\n".repeat(5_000)).unwrap();
    fs::write(dir.join("a.obj"), "mtllib a.mtl\n".repeat(200_000) + TRIANGLE).unwrap();
    let start = Instant::now();
    assert_eq!(materials_of(&dir, "a.obj", &[])[0]["double_sided"], true);
    assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
    let many: String = (0..200_000).map(|k| format!("mtllib {k}.mtl\n")).collect();
    fs::write(dir.join("b.obj"), many + TRIANGLE).unwrap();
    let line = bad(&dir, &["info", "b.obj"]);
    assert!(line.contains("line 4097") && line.contains("files that it names"), "{line}");
}

#[test]
fn pictures_of_materials_lie_below_their_file() {
    let dir = place("named-pictures");
    fs::write(dir.join("rose.svg"), FLOWER).unwrap();
    let write = |picture: &str| {
        let text = format!("[petal]\npattern = \"picture\"\npicture = {}\n", Value::from(picture));
        fs::write(dir.join("in/m.toml"), text).unwrap();
    };
    let args = ["sketch", "rose.svg", "--materials", "in/m.toml", "-o", "x.glb", "-q"];
    write("t.png");
    good(&dir, &args);
    for picture in ["../secret.png", "..\\secret.png", dir.join("secret.png").to_str().unwrap()] {
        write(picture);
        needs_trust(&dir, &args, &["in/m.toml: names", "secret.png"]);
    }
    write("none.png");
    assert!(bad(&dir, &args).contains("which is not there; check the spelling"));
    write("p.bin");
    assert!(bad(&dir, &args).contains("in/p.bin: is no PNG or JPEG picture"));
    write("large.png");
    fs::File::create(dir.join("in/large.png")).unwrap().set_len(65 << 20).unwrap();
    never(&dir, &args, &["\"large.png\"", "larger than 64 MiB"]);
}

const SPEC: &str = "[method]\nkind = \"colonization\"\npoints = 60\n\
                    envelope = { shape = \"sphere\", centre = [0.0, 1.0, 0.0], radius_m = 0.5 }\n";

#[test]
fn meshes_and_leaves_of_a_spec_lie_below_it() {
    let dir = place("named-spec");
    let write = |name: &str, text: &str| fs::write(dir.join(name), text).unwrap();
    let args = ["grow", "in/s.toml", "-o", "x.stl", "-q"];
    let named = |file: &str| format!("{SPEC}[[obstacles]]\nshape = \"mesh\"\nfile = {}\n", Value::from(file));
    write("in/box.obj", &TRIANGLE.replace("v 0", "v 5"));
    write("box.obj", &TRIANGLE.replace("v 0", "v 5"));
    write("in/s.toml", &named("box.obj"));
    good(&dir, &args);
    for file in ["../box.obj", "..\\box.obj", dir.join("box.obj").to_str().unwrap()] {
        write("in/s.toml", &named(file));
        needs_trust(&dir, &args, &["in/s.toml: names", "box.obj"]);
    }
    // Files that a mesh names in its turn.
    write("in/s.toml", &named("box.obj"));
    write("in/box.obj", &format!("mtllib ../other.mtl\n{}", TRIANGLE.replace("v 0", "v 5")));
    write("other.mtl", "newmtl wood\n");
    needs_trust(&dir, &args, &["in/box.obj: names \"../other.mtl\""]);
    let points = "[method]\nkind = \"colonization\"\npoints = 60\n\
                  envelope = { shape = \"points\", file = \"../p.xyz\", reach_m = 0.3 }\n";
    write("p.xyz", "0 1 0\n0.1 1 0\n0 1.1 0\n0 1 0.1\n");
    write("in/s.toml", points);
    needs_trust(&dir, &args, &["in/s.toml: names \"../p.xyz\""]);
    let leaf = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/leaves/leaf1.csv");
    fs::copy(leaf, dir.join("leaf.csv")).unwrap();
    write("in/s.toml", &format!("{SPEC}[blade]\nfile = \"../leaf.csv\"\n"));
    needs_trust(&dir, &args, &["in/s.toml: names \"../leaf.csv\""]);
    // Files that an option names are trusted: somebody typed them.
    good(&dir, &[&args[..], &["--leaf-template", "leaf.csv"]].concat());
    // A spec without a folder lies in the current one.
    let inner = dir.join("in");
    fs::write(inner.join("s.toml"), named("box.obj")).unwrap();
    fs::write(inner.join("box.obj"), TRIANGLE.replace("v 0", "v 5")).unwrap();
    good(&inner, &["grow", "s.toml", "-o", "x.stl", "-q"]);
}

#[test]
fn scans_of_stages_lie_below_their_file() {
    let dir = folder("named-stages");
    fs::create_dir(dir.join("in")).unwrap();
    let sheet = |length: f64| -> String {
        (0..1200)
            .map(|i| {
                let (u, v) = (f64::from(i % 60) / 59.0, f64::from(i / 60) / 19.0 - 0.5);
                format!("{:.5} {:.5} 0\n", v * (0.2 * u * (1.0 - u) + 0.004), length * u)
            })
            .collect()
    };
    let mut stages = String::new();
    for day in 0..3 {
        let file = format!("{day}.xyz");
        fs::write(dir.join("in").join(&file), sheet(0.1 + 0.02 * f64::from(day))).unwrap();
        stages += &format!("[[stage]]\nfile = \"{file}\"\nday = {day}\norgan = \"x\"\n");
    }
    let args = ["bloom", "fit", "in/s.toml", "-o", "x.json", "-q"];
    fs::write(dir.join("in/s.toml"), &stages).unwrap();
    good(&dir, &args);
    fs::rename(dir.join("in/1.xyz"), dir.join("1.xyz")).unwrap();
    for file in ["../1.xyz", "..\\\\1.xyz"] {
        fs::write(dir.join("in/s.toml"), stages.replace("\"1.xyz", &format!("\"{file}"))).unwrap();
        needs_trust(&dir, &args, &["in/s.toml: names", "1.xyz"]);
    }
    fs::write(dir.join("in/s.toml"), &stages).unwrap();
    assert!(bad(&dir, &args).contains("in/1.xyz: cannot be read: there is no such file"));
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::os::unix::fs::symlink;
    use std::process::Command;

    /// Makes a file whose name another one names: a link out of the folder, a pipe, a device.
    fn odd(dir: &Path, name: &str, to: Option<&str>) {
        let path = dir.join("in").join(name);
        let _ = fs::remove_file(&path);
        match to {
            Some(to) => symlink(to, path).unwrap(),
            None => assert!(Command::new("mkfifo").arg(path).status().unwrap().success(), "mkfifo"),
        }
    }

    #[test]
    fn links_pipes_and_devices_are_not_read_by_any_name() {
        let dir = place("named-odd");
        let write = |name: &str, text: &str| fs::write(dir.join("in").join(name), text).unwrap();
        fs::write(dir.join("rose.svg"), FLOWER).unwrap();
        fs::write(dir.join("secret.mtl"), "newmtl wood\n").unwrap();
        fs::write(dir.join("secret.obj"), TRIANGLE.replace("v 0", "v 5")).unwrap();
        write("a.gltf", &gltf("odd.bin"));
        write("a.obj", &format!("mtllib odd.mtl\n{TRIANGLE}"));
        write("a.mtl", "newmtl wood\nmap_Kd odd.png\n");
        write("b.obj", &format!("mtllib a.mtl\n{TRIANGLE}"));
        write("m.toml", "[petal]\npattern = \"picture\"\npicture = \"odd.png\"\n");
        write("s.toml", &format!("{SPEC}[[obstacles]]\nshape = \"mesh\"\nfile = \"odd.obj\"\n"));
        let uses: [(&str, &str, &[&str]); 5] = [
            ("odd.bin", "secret.bin", &["info", "in/a.gltf"]),
            ("odd.mtl", "secret.mtl", &["info", "in/a.obj"]),
            ("odd.png", "secret.png", &["info", "in/b.obj"]),
            (
                "odd.png",
                "secret.png",
                &["sketch", "rose.svg", "--materials", "in/m.toml", "-o", "x.glb", "-q"],
            ),
            ("odd.obj", "secret.obj", &["grow", "in/s.toml", "-o", "x.stl", "-q"]),
        ];
        for (name, secret, args) in uses {
            let quoted = format!("{name:?}");
            odd(&dir, name, Some(&format!("../{secret}")));
            needs_trust(&dir, args, &[&quoted, "a link that leads out of its folder"]);
            odd(&dir, name, None);
            never(&dir, args, &[&quoted, "a pipe, not a file"]);
            let line = bad(&dir, args);
            assert!(line.contains("a pipe"), "{line}");
            odd(&dir, name, Some("/dev/zero"));
            never(&dir, args, &[&quoted, "a device, not a file"]);
        }
        // A folder that is a link.
        symlink("..", dir.join("in/up")).unwrap();
        write("a.gltf", &gltf("up/secret.bin"));
        needs_trust(&dir, &["info", "in/a.gltf"], &["up/secret.bin", "a link that leads out"]);
        // A link that stays inside is as good as a file, and the model itself may be reached by a link.
        symlink("p.bin", dir.join("in/inside.bin")).unwrap();
        write("a.gltf", &gltf("inside.bin"));
        good(&dir, &["info", "in/a.gltf"]);
        symlink("in", dir.join("other")).unwrap();
        good(&dir, &["info", "other/a.gltf"]);
    }

    #[test]
    fn what_an_option_names_may_be_a_device_and_is_bounded() {
        let dir = folder("named-texture");
        let leaf = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/leaves/leaf1.csv");
        never(&dir, &["leaf", leaf, "--texture", "/dev/zero", "-o", "x.glb"], &["/dev/zero", "64 MiB"]);
        never(&dir, &["replay", "/dev/zero", "--png", "x.png"], &["/dev/zero", "256 MiB"]);
    }
}

/// One compressed scan of 3,000 bytes asked for 4 GB.
#[test]
fn a_compressed_scan_takes_no_memory_for_what_it_merely_claims() {
    let dir = folder("named-laz");
    let mut head = vec![0; 375];
    let mut put = |at: usize, bytes: &[u8]| head[at..at + bytes.len()].copy_from_slice(bytes);
    put(0, b"LASF");
    put(24, &[1, 4]);
    put(94, &375_u16.to_le_bytes());
    put(96, &(375_u32 + 54 + 40).to_le_bytes());
    put(100, &1_u32.to_le_bytes());
    put(104, &[0x86, 30, 0]);
    for k in 0..3 {
        put(131 + 8 * k, &0.01_f64.to_le_bytes());
    }
    let mut vlr = vec![0; 54];
    vlr[2..16].copy_from_slice(b"laszip encoded");
    vlr[18..20].copy_from_slice(&22204_u16.to_le_bytes());
    vlr[20] = 40;
    // Layers, of chunks of 50,000 points, of one part: a point of format 6 in version 3.
    let mut how = vec![3, 0, 0, 0, 2, 2, 0, 0, 0, 0, 0, 0];
    how.extend_from_slice(&50_000_u32.to_le_bytes());
    how.extend_from_slice(&[0xff; 16]);
    how.extend_from_slice(&[1, 0, 10, 0, 30, 0, 3, 0]);
    let data_at = head.len() + vlr.len() + how.len();
    let file = |points: u64, layer: u32, chunks: u32| {
        let mut head = head.clone();
        head[247..255].copy_from_slice(&points.to_le_bytes());
        let mut file = [&head[..], &vlr, &how].concat();
        assert_eq!(file.len(), data_at);
        file.extend_from_slice(&2_984_i64.to_le_bytes());
        file.extend_from_slice(&[7; 30]);
        file.extend_from_slice(&1000_u32.to_le_bytes());
        (0..9).for_each(|_| file.extend_from_slice(&layer.to_le_bytes()));
        file.resize(2_984, 0);
        file.extend_from_slice(&[0; 4]);
        file.extend_from_slice(&chunks.to_le_bytes());
        file.extend_from_slice(&[0; 8]);
        file
    };
    for (bytes, part) in [
        (file(1000, 0xf000_0000, 0), "point 0 cannot be unpacked"),
        (file(1000, 40, 0x1000_0000), "268435456 chunks are announced"),
        (file(30_000_000, 40, 1), "30000000 points are announced in 25"),
    ] {
        assert_eq!(bytes.len(), 3_000);
        fs::write(dir.join("a.laz"), bytes).unwrap();
        let out = burgeon(&dir, &["convert", "a.laz", "-o", "x.ply"]);
        let line = String::from_utf8_lossy(&out.stderr);
        assert!(status(&out) == 2 && line.contains(part) && !line.contains("memory"), "{line}");
        assert!(!line.contains("Error:") && !line.contains("buffer"), "words of a library: {line}");
    }
}

fn table(dir: &Path, name: &str, rows: u32, plants: u32) {
    use std::fmt::Write as _;
    let mut text = String::from("day,size,plant\n");
    for k in 0..rows {
        let day = f64::from(k / plants) * 400.0 / f64::from(rows / plants);
        // A curve with an even scatter.
        let size = 100.0 * (day + 10.0) / (day + 150.0) + (f64::from(k) * 0.618).fract() - 0.5;
        writeln!(text, "{day:.6},{size:.4},{}", k % plants).unwrap();
    }
    fs::write(dir.join(name), text).unwrap();
}

/// 12,000 rows once took half a minute, or two minutes as one series.
#[test]
fn growth_tables_take_time_in_proportion_to_their_rows_or_are_refused() {
    let dir = folder("named-tables");
    for plants in [1, 4000] {
        table(&dir, "t.csv", 12_000, plants);
        let start = Instant::now();
        good(&dir, &["bloom", "fit", "t.csv", "-o", "x.json", "-q"]);
        assert!(start.elapsed() < Duration::from_secs(60), "{plants} plants took {:?}", start.elapsed());
    }
    table(&dir, "t.csv", 100_000, 1000);
    let start = Instant::now();
    let line = bad(&dir, &["bloom", "fit", "t.csv", "-o", "y.json"]);
    assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
    for part in ["t.csv", "comparisons of sizes with growth laws", "split the table", "--budget 3"] {
        assert!(line.contains(part), "{line}");
    }
    assert!(!dir.join("y.json").exists());
}
