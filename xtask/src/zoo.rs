//! `cargo xtask zoo`: a model repository of one's own, static files for a web server or a shared folder.

use std::fs;
use std::io::{Cursor, Read};
use std::path::{Component, Path, PathBuf};

use minisign::{KeyPair, PublicKey, SecretKey, SecretKeyBox};
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use crate::shell::Result;

const MANIFEST: &str = "model.json";
const INDEX: &str = "index.json";
/// Deepest folder of a container below a source.
const DEPTH: usize = 4;

/// Writes a new secret key to `file` and its public key to `file.pub`.
pub fn key(file: &Path) -> Result<()> {
    let public = with_extension(file, "pub");
    if let Some(existing) = [file, &public].into_iter().find(|path| path.exists()) {
        return Err(format!("{} exists; a lost secret key cannot be replaced", existing.display()));
    }
    let pair = KeyPair::generate_unencrypted_keypair().map_err(|error| error.to_string())?;
    let secret = pair.sk.to_box(None).map_err(|error| error.to_string())?.to_string();
    let text = pair.pk.to_box().map_err(|error| error.to_string())?.to_string();
    write_secret(file, &secret)?;
    write(&public, text.as_bytes())?;
    println!("secret key: {}; keep it off the server (minisign -C sets a password)", file.display());
    println!("public key: {}; users set OPENDR_MODEL_KEY={}", public.display(), pair.pk.to_base64());
    Ok(())
}

/// Copies the containers of `sources` into the repository `target`, signs them if there is a key, and writes the index. Files that are
/// there already and whole are not copied again.
pub fn publish(target: &Path, secret: Option<&Path>, sources: &[&str]) -> Result<()> {
    if sources.is_empty() {
        return Err(
            "give containers, or folders of them, such as \"opendr download MODEL --to FOLDER\" writes"
                .to_owned(),
        );
    }
    let signer = secret.map(Signer::open).transpose()?;
    for source in sources.iter().map(Path::new) {
        let found = containers(source)?;
        if found.is_empty() {
            return Err(format!("{}: no {MANIFEST} in it or in its folders", source.display()));
        }
        for container in found {
            container.copy(source, target, signer.as_ref())?;
        }
    }
    index(target, signer.as_ref())
}

/// A container below a source.
struct Container {
    folder: PathBuf,
    /// Relative path in the repository.
    place: PathBuf,
    manifest: Value,
    bytes: Vec<u8>,
}

impl Container {
    fn open(folder: PathBuf, place: Option<PathBuf>) -> Result<Self> {
        let path = folder.join(MANIFEST);
        let bytes = read(&path)?;
        let manifest: Value =
            serde_json::from_slice(&bytes).map_err(|error| format!("{}: {error}", path.display()))?;
        let name = |key: &str| manifest[key].as_str().unwrap_or_default();
        let place = place.unwrap_or_else(|| Path::new(name("learner")).join(name("variant")));
        if name("learner").is_empty() || name("variant").is_empty() {
            let path = path.display();
            return Err(format!(
                "{path} has no \"learner\" or no \"variant\": name the model, by which users find it"
            ));
        }
        for part in [name("learner"), name("variant")].map(Path::new).into_iter().chain([place.as_path()]) {
            inside(part)?;
        }
        Ok(Self { folder, place, manifest, bytes })
    }

    /// Returns name, size and checksum of each file.
    fn files(&self) -> Result<Vec<(&str, u64, &str)>> {
        let entries = self.manifest["files"].as_array().map(Vec::as_slice).unwrap_or_default();
        let read = |entry| -> Result<_> {
            let entry: &Value = entry;
            match (entry["name"].as_str(), entry["size"].as_u64(), entry["sha256"].as_str()) {
                (Some(name), Some(size), Some(sha256)) => {
                    inside(Path::new(name))?;
                    Ok((name, size, sha256))
                }
                _ => Err(format!("{}: a file without name, size or sha256", self.folder.display())),
            }
        };
        entries.iter().map(read).collect()
    }

    fn copy(&self, source: &Path, target: &Path, signer: Option<&Signer>) -> Result<()> {
        let target = target.join(&self.place);
        let (mut copied, mut kept) = (0, 0);
        for (name, size, sha256) in self.files()? {
            let path = target.join(name);
            if is_whole(&path, size, sha256) {
                kept += 1;
                continue;
            }
            let bytes = read(&self.folder.join(name))?;
            if bytes.len() as u64 != size || checksum(&bytes) != sha256 {
                return Err(format!(
                    "{}: size or checksum is not that of {MANIFEST}",
                    self.folder.join(name).display()
                ));
            }
            write(&path, &bytes)?;
            copied += 1;
        }
        let path = target.join(MANIFEST);
        write(&path, &self.bytes)?;
        match signer {
            Some(signer) => signer.sign(&path, &self.bytes, &self.place)?,
            // A signature of earlier contents would refuse the new ones.
            None => drop(fs::remove_file(with_extension(&path, "minisig"))),
        }
        println!(
            "{}: {copied} files copied, {kept} there already, from {}",
            self.place.display(),
            source.display()
        );
        Ok(())
    }
}

/// The secret key of the repository.
struct Signer {
    secret: SecretKey,
    public: PublicKey,
}

impl Signer {
    fn open(path: &Path) -> Result<Self> {
        let text = String::from_utf8(read(path)?).map_err(|_| format!("{} is no text", path.display()))?;
        let sealed =
            || SecretKeyBox::from_string(&text).map_err(|error| format!("{}: {error}", path.display()));
        let secret = match std::env::var("OPENDR_SIGNING_PASSWORD") {
            Ok(password) => sealed()?.into_secret_key(Some(password)),
            Err(_) => sealed()?.into_unencrypted_secret_key(),
        };
        let secret = secret.map_err(|error| {
            format!("{}: {error}; a key with a password needs OPENDR_SIGNING_PASSWORD", path.display())
        })?;
        let public = PublicKey::from_secret_key(&secret).map_err(|error| error.to_string())?;
        Ok(Self { secret, public })
    }

    /// Writes the signature beside a file.
    fn sign(&self, path: &Path, bytes: &[u8], place: &Path) -> Result<()> {
        let place = format!("opendr {}", place.display());
        let signature =
            minisign::sign(Some(&self.public), &self.secret, Cursor::new(bytes), Some(&place), Some(&place));
        let signature = signature.map_err(|error| format!("{}: {error}", path.display()))?;
        write(&with_extension(path, "minisig"), signature.to_string().as_bytes())
    }
}

/// Returns the containers in a folder, at most [`DEPTH`] folders deep, in the order of their paths.
fn containers(source: &Path) -> Result<Vec<Container>> {
    if source.join(MANIFEST).is_file() {
        return Ok(vec![Container::open(source.to_owned(), None)?]);
    }
    let mut found = Vec::new();
    let mut open = vec![PathBuf::new()];
    while let Some(place) = open.pop() {
        let folder = source.join(&place);
        if folder.join(MANIFEST).is_file() {
            found.push(Container::open(folder, Some(place))?);
            continue;
        }
        if place.components().count() == DEPTH {
            continue;
        }
        let entries = fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        for entry in entries {
            let entry = entry.map_err(|error| format!("{}: {error}", folder.display()))?;
            if entry.path().is_dir() {
                open.push(place.join(entry.file_name()));
            }
        }
    }
    found.sort_by(|one, other| one.place.cmp(&other.place));
    Ok(found)
}

/// Writes the list of everything in the repository.
fn index(target: &Path, signer: Option<&Signer>) -> Result<()> {
    let models: Result<Vec<_>> = containers(target)?
        .iter()
        .map(|container| {
            let bytes: u64 = container.files()?.iter().map(|(_, size, _)| size).sum();
            Ok(json!({
                "place": container.place,
                "learner": container.manifest["learner"],
                "variant": container.manifest["variant"],
                "task": container.manifest["task"],
                "bytes": bytes,
                "manifest_sha256": checksum(&container.bytes),
            }))
        })
        .collect();
    let models = models?;
    let index = json!({ "format_version": 1, "models": models });
    let text = serde_json::to_vec_pretty(&index).map_err(|error| error.to_string())?;
    let path = target.join(INDEX);
    write(&path, &text)?;
    if let Some(signer) = signer {
        signer.sign(&path, &text, Path::new(INDEX))?;
    }
    println!("{}: {} models", path.display(), models.len());
    println!("users set OPENDR_MODEL_REPOSITORY to the address or the path of {}", target.display());
    if let Some(signer) = signer {
        println!("and OPENDR_MODEL_KEY={}", signer.public.to_base64());
    }
    Ok(())
}

/// Returns an error for a path that leads out of its folder.
fn inside(path: &Path) -> Result<()> {
    let is_plain = path.components().all(|part| matches!(part, Component::Normal(_)));
    if is_plain { Ok(()) } else { Err(format!("{}: not a path below its folder", path.display())) }
}

fn is_whole(path: &Path, size: u64, sha256: &str) -> bool {
    let has_size = fs::metadata(path).is_ok_and(|file| file.len() == size);
    has_size && fs::read(path).is_ok_and(|bytes| checksum(&bytes) == sha256)
}

fn checksum(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

fn read(path: &Path) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let file = fs::File::open(path).and_then(|mut file| file.read_to_end(&mut bytes));
    file.map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(bytes)
}

/// Writes a file in one step, so that a server never serves half of it.
fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    let part = with_extension(path, "part");
    let done = path.parent().map_or(Ok(()), fs::create_dir_all).and_then(|()| fs::write(&part, bytes));
    done.and_then(|()| fs::rename(&part, path)).map_err(|error| format!("{}: {error}", path.display()))
}

/// Writes a file that only its owner can read.
fn write_secret(path: &Path, text: &str) -> Result<()> {
    write(path, b"")?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        let owner = fs::set_permissions(path, fs::Permissions::from_mode(0o600));
        owner.map_err(|error| format!("{}: {error}", path.display()))?;
    }
    fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}

/// Returns the path with another extension after its own.
fn with_extension(path: &Path, extension: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".");
    name.push(extension);
    name.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A new folder with a container `nanodet/own` of one file.
    fn place(name: &str) -> PathBuf {
        let place = std::env::temp_dir().join(format!("xtask-zoo-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&place);
        let manifest = json!({
            "format_version": 1, "learner": "nanodet", "variant": "own", "task": "object_detection_2d",
            "files": [{ "name": "model.onnx", "size": 7, "sha256": checksum(b"weights") }],
        });
        write(&place.join("run/model/model.onnx"), b"weights").unwrap();
        write(&place.join("run/model/model.json"), manifest.to_string().as_bytes()).unwrap();
        place
    }

    #[test]
    fn containers_are_copied_signed_and_listed() {
        let place = place("signed");
        let (target, secret, model) = (place.join("www"), place.join("key"), place.join("run/model"));
        key(&secret).unwrap();
        assert!(key(&secret).unwrap_err().contains("exists"));
        let sources = [model.to_str().unwrap()];
        publish(&target, Some(&secret), &sources).unwrap();
        let public = PublicKey::from_file(place.join("key.pub")).unwrap();
        for (path, comment) in
            [("nanodet/own/model.json", "opendr nanodet/own"), ("index.json", "opendr index.json")]
        {
            let signature = target.join(format!("{path}.minisig"));
            let signature = minisign::SignatureBox::from_file(signature).unwrap();
            let content = read(&target.join(path)).unwrap();
            minisign::verify(&public, &signature, Cursor::new(content), true, false, false).unwrap();
            assert_eq!(signature.trusted_comment().unwrap(), comment);
        }
        let index: Value = serde_json::from_slice(&read(&target.join(INDEX)).unwrap()).unwrap();
        assert_eq!(index["models"][0]["place"], "nanodet/own");
        assert_eq!(index["models"][0]["bytes"], 7);

        // What is there and whole needs no source; what is damaged is copied again.
        fs::remove_file(model.join("model.onnx")).unwrap();
        publish(&target, Some(&secret), &sources).unwrap();
        write(&target.join("nanodet/own/model.onnx"), b"weighty").unwrap();
        assert!(publish(&target, Some(&secret), &sources).unwrap_err().contains("model.onnx"));
        write(&model.join("model.onnx"), b"weights").unwrap();
        // A folder of containers keeps their places; without a key, the signature goes.
        publish(&target, None, &[place.join("run").to_str().unwrap()]).unwrap();
        assert_eq!(read(&target.join("model/model.onnx")).unwrap(), b"weights");
        publish(&target, None, &sources).unwrap();
        assert!(!target.join("nanodet/own/model.json.minisig").exists());
        fs::remove_dir_all(place).unwrap();
    }

    #[test]
    fn damaged_and_hostile_containers_are_refused() {
        let place = place("hostile");
        let (target, model) = (place.join("www"), place.join("run/model"));
        let sources = [model.to_str().unwrap()];
        assert!(publish(&target, None, &[]).unwrap_err().contains("give containers"));
        assert!(publish(&target, None, &[target.to_str().unwrap()]).is_err());
        write(&model.join("model.onnx"), b"weighty").unwrap();
        assert!(publish(&target, None, &sources).unwrap_err().contains("checksum"));
        let text = String::from_utf8(read(&model.join(MANIFEST)).unwrap()).unwrap();
        for (from, to) in [
            ("\"own\"", "\"../../own\""),
            ("\"own\"", "\"\""),
            ("model.onnx", "/etc/passwd"),
            ("\"size\":7", "\"size\":-7"),
            ("{", "["),
        ] {
            let changed = text.replacen(from, to, 1);
            assert_ne!(changed, text, "{from}");
            write(&model.join(MANIFEST), changed.as_bytes()).unwrap();
            assert!(publish(&target, None, &sources).is_err(), "{to}");
        }
        assert!(!place.join("own").exists());
        fs::remove_dir_all(place).unwrap();
    }
}
