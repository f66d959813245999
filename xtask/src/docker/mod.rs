//! `cargo xtask docker`: the steps of the image for processors in a folder, on machines without Docker.
//!
//! The instructions are those of the Dockerfile ([`dockerfile`]). The base image is a Debian system that mmdebstrap makes from this
//! machine's mirror, the steps run in it by chroot, with this machine's network. The stage that compiles is not run: its files are those
//! of a folder of built programs. Images of other publishers (Rust, CUDA) cannot be made this way, so that they are only parsed.

mod dockerfile;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::inputs;
use crate::shell::{Result, command, is_installed, output, root, step, target};
use dockerfile::{Stage, Step};

/// The images of this repository.
pub const FILES: [&str; 2] = ["packaging/docker/Dockerfile", "packaging/docker/Dockerfile.cuda"];

/// Folder of the stage that compiles which other stages copy from.
const BUILT: &str = "/out/";

/// Files of this machine by which the steps reach the network.
const NETWORK: [&str; 3] = ["etc/resolv.conf", "etc/hosts", "etc/apt"];

/// Runs the steps of the image for processors with the programs of the folder `binaries`, then its program.
pub fn run(binaries: &Path) -> Result<()> {
    for file in FILES {
        dockerfile::parse(&inputs::text(file)?).map_err(|error| format!("{file}: {error}"))?;
    }
    for tool in ["mmdebstrap", "chroot"] {
        if !is_installed(tool) {
            return Err(format!("{tool} is not installed; run \"apt-get install mmdebstrap\" as root"));
        }
    }
    let stages = dockerfile::parse(&inputs::text(FILES[0])?)?;
    let last = stages.last().ok_or("there is no stage")?;
    let system = System::new(&last.image)?;
    let done = system.run(last, binaries);
    system.close();
    done
}

/// A system of Debian in a folder.
struct System {
    folder: PathBuf,
}

/// What the steps set for those after them.
struct Container {
    user: String,
    folder: String,
    variables: Vec<(String, String)>,
    program: Vec<String>,
    arguments: Vec<String>,
}

impl System {
    /// Creates the system of an image `debian:SUITE-slim`.
    fn new(image: &str) -> Result<Self> {
        let suite = image.strip_prefix("debian:").map(|tag| tag.trim_end_matches("-slim"));
        let suite =
            suite.ok_or_else(|| format!("{image} is no image of Debian, which cannot be made here"))?;
        let folder =
            std::path::absolute(target().join("docker/system")).map_err(|error| error.to_string())?;
        // A missing folder is no error.
        fs::remove_dir_all(&folder).ok();
        fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        let mut debootstrap = Command::new("mmdebstrap");
        debootstrap.args(["--mode=root", "--variant=minbase", "--quiet", suite]).arg(&folder);
        step(&format!("system of {image}"), &mut debootstrap)?;
        let system = Self { folder };
        for file in NETWORK {
            let from = Path::new("/").join(file);
            let to = system.folder.join(file);
            let parent = to.parent().unwrap_or(&system.folder).to_owned();
            output(command("cp").args(["--recursive", "--dereference"]).arg(from).arg(parent))?;
        }
        output(command("mount").args(["--bind", "/dev"]).arg(system.folder.join("dev")))?;
        output(command("mount").args(["-t", "proc", "proc"]).arg(system.folder.join("proc")))?;
        Ok(system)
    }

    /// Takes the mounts away.
    fn close(&self) {
        for folder in ["dev", "proc"] {
            // What is not mounted needs no unmounting.
            output(command("umount").arg(self.folder.join(folder))).ok();
        }
    }

    fn run(&self, stage: &Stage, binaries: &Path) -> Result<()> {
        let mut container = Container {
            user: "root".to_owned(),
            folder: "/".to_owned(),
            variables: Vec::new(),
            program: Vec::new(),
            arguments: Vec::new(),
        };
        for instruction in &stage.steps {
            match instruction {
                Step::Run(line) => step(line, &mut self.chroot(&container, &["/bin/sh", "-c", line]))?,
                Step::Copy { from, paths } => self.copy(from.as_deref(), paths, binaries)?,
                Step::Env(variables) => container.variables.extend(variables.iter().cloned()),
                Step::Workdir(folder) => {
                    container.folder.clone_from(folder);
                    let path = self.inside(folder);
                    fs::create_dir_all(&path).map_err(|error| format!("{}: {error}", path.display()))?;
                }
                Step::User(user) => container.user.clone_from(user),
                Step::Entrypoint(words) => container.program.clone_from(words),
                Step::Cmd(words) => container.arguments.clone_from(words),
                Step::About => {}
            }
        }
        let words =
            |arguments: &[String]| container.program.iter().chain(arguments).cloned().collect::<Vec<_>>();
        for arguments in
            [container.arguments.clone(), vec!["--version".to_owned()], vec!["models".to_owned()]]
        {
            let words = words(&arguments);
            let words: Vec<_> = words.iter().map(String::as_str).collect();
            step(&format!("container as {}", container.user), &mut self.chroot(&container, &words))?;
        }
        let user = output(&mut self.chroot(&container, &["id", "--user"]))?;
        let mut size = command("du");
        let size = output(
            size.args([
                "--summarize",
                "--block-size=1M",
                "--one-file-system",
                "--exclude=./proc",
                "--exclude=./dev",
            ])
            .arg(&self.folder),
        )?;
        println!(
            "user {}, {} MiB in {}",
            user.trim(),
            size.split_whitespace().next().unwrap_or_default(),
            self.folder.display()
        );
        Ok(())
    }

    /// Returns a command in the system, with the variables of the container alone.
    fn chroot(&self, container: &Container, words: &[&str]) -> Command {
        let mut chroot = command("env");
        chroot.args([
            "--ignore-environment",
            "PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin",
        ]);
        chroot.arg("DEBIAN_FRONTEND=noninteractive");
        chroot.args(container.variables.iter().map(|(name, value)| format!("{name}={value}")));
        chroot.arg("chroot").arg(format!("--userspec={0}:{0}", container.user)).arg(&self.folder);
        chroot.args(["/usr/bin/env", "--chdir", &container.folder]).args(words);
        chroot
    }

    fn copy(&self, from: Option<&str>, paths: &[String], binaries: &Path) -> Result<()> {
        let Some((to, sources)) = paths.split_last() else { return Ok(()) };
        for source in sources {
            let path = match from {
                None => root().join(source),
                Some(_) => {
                    let name = source.strip_prefix(BUILT);
                    binaries.join(
                        name.ok_or_else(|| format!("COPY copies {source}, which is not below {BUILT}"))?,
                    )
                }
            };
            let to = self.inside(to);
            let parent = to.parent().unwrap_or(&self.folder);
            fs::create_dir_all(parent).map_err(|error| format!("{}: {error}", parent.display()))?;
            output(command("cp").args(["--recursive", "--no-target-directory"]).arg(path).arg(to))?;
        }
        Ok(())
    }

    fn inside(&self, path: &str) -> PathBuf {
        self.folder.join(path.trim_start_matches('/'))
    }
}
