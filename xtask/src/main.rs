//! Development tasks: checks, code generation, wheels, installation of the C library.
//!
//! `cargo xtask` without arguments lists the tasks. Each task is a module; `checks` runs and skips the steps of the test task,
//! `shell` runs programs.

mod card;
mod checks;
#[cfg(unix)]
mod deb;
mod deny;
#[cfg(unix)]
mod docker;
mod function_docs;
mod generate;
mod imports;
mod inputs;
mod install_c;
mod junit;
mod layers;
mod learner_table;
mod lexer;
mod linked;
mod models;
mod opendr;
mod pages;
mod parity;
mod passages;
mod publish;
mod realtime;
mod release;
mod reproducible;
mod ros;
mod rust_tests;
mod sbom;
mod shell;
mod ship;
mod site;
mod source_date;
mod spdx;
mod speed;
mod suite;
mod surfaces;
mod test;
mod tools;
mod train;
mod wheel;
mod words;
mod workspace;
mod zoo;

use std::process::ExitCode;

const USAGE: &str = "\
usage: cargo xtask VERB

  test       run all checks of CI; install their dependencies (Debian packages, Python environments in target/);
             skip checks that passed in this build folder and whose inputs have not changed since
  test --all
             run all checks without skipping any
  ship       build the wheels for users in the profile dist, and test them
  test-extended
             run the tests that need PyTorch, with the interpreter OPENDR_TORCH_PYTHON
  test-c     run only the tests of the C library
  ros        run only the tests of messages and nodes with real ROS peers
  ros --zenoh
             run the tests of the feature zenoh with a Zenoh router and peer; not part of the task test
  generate   write the generated stubs, C headers, pages of docs/, and parts of README.md and DESIGN.md
  generate --crates
             write only what needs no build: the tables of README.md, docs/models.md and docs/opendr.md, and the diagram of DESIGN.md
  words      fail if documentation or messages have a phrase of xtask/words.tsv, and print the term to use; or if the documentation of
             a public function does not begin with a verb
  layers     fail if a crate depends on a higher layer of xtask/layers.tsv, or if two files of a crate import each other
  site       build the documentation site into target/site, with the predictions of the built command, or of OPENDR_BIN, on photographs
  site --check
             build it without predictions; fail on broken links, missing anchors, and pages outside of the navigation
  realtime   fail if a task has no learner with 25 frames per second in 1 GB on 2 cores
  realtime --write
             also write the measurements into the cards; needs an otherwise idle machine
  train NAME
             make the weights of models/training/NAME.toml, measure them, compare with the expected figure, and write it into the
             card; resume an interrupted training
  train NAME --gpu
             train through Vulkan
  zoo key FILE
             write a secret key for a model repository, and its public key FILE.pub (minisign)
  zoo publish TARGET [--key FILE] CONTAINER...
             copy containers, or folders of them, into the model repository TARGET, sign them, and write its index; an interrupted
             run goes on where it ended
  install-c PREFIX
             install the C library with its headers, pkg-config file and CMake package under PREFIX
  deb        build Debian packages in the profile dist into target/deb, and check them with lintian
  deb --binaries DIR
             pack the built programs and libraries of a folder instead
  docker --binaries DIR
             parse the Dockerfiles and run the steps of the image for processors in a folder, with the built programs of DIR; needs root
  publish --dry-run
             check and pack the crates that users depend on, and list them in the order of their publication
  publish    also publish those that the registry does not have
  release VERSION
             write the version into all files, commit and tag it; pushes nothing
  reproducible PACKAGE [PROFILE]
             build a package in two folders, in the profile dist or another, and fail if the files differ
  sbom       write the bills of materials of the packages (CycloneDX) into target/sbom
  deny       fail if a dependency has a licence, source or version that deny.toml does not allow, or a known vulnerability

environment:
  OPENDR_TEST_DATA   folder with models/ and data/; without it, tests that need it are skipped";

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let done = match words.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["test"] => test::run(false),
        ["test", "--all"] => test::run(true),
        ["ship"] => ship::run(),
        ["test-extended"] => test::run_extended(),
        ["test-c"] => test::run_c(),
        ["ros"] => ros::run_alone(),
        ["ros", "--zenoh"] => ros::run_zenoh(),
        ["words"] => words::run().and_then(|()| function_docs::check()),
        ["layers"] => layers::run(),
        ["generate"] => generate::run(),
        ["generate", "--crates"] => pages::write(),
        ["site"] => site::run(site::Show::Everything),
        ["site", "--check"] => site::run(site::Show::Pages),
        ["realtime"] => realtime::run(),
        ["realtime", "--write"] => realtime::run_and_write(),
        ["train", name] => train::run(name, false),
        ["train", name, "--gpu"] => train::run(name, true),
        #[cfg(unix)]
        ["deb"] => deb::run(None),
        #[cfg(unix)]
        ["deb", "--binaries", folder] => deb::run(Some(folder.as_ref())),
        #[cfg(unix)]
        ["docker", "--binaries", folder] => docker::run(folder.as_ref()),
        ["publish", "--dry-run"] => publish::run(true),
        ["publish"] => publish::run(false),
        ["release", version] => release::run(version),
        ["reproducible", package] => reproducible::run(package, "dist"),
        ["reproducible", package, profile] => reproducible::run(package, profile),
        ["sbom"] => sbom::run(),
        ["deny"] => deny::run(),
        ["install-c", prefix] => install_c::run(prefix.as_ref()),
        ["zoo", "key", file] => zoo::key(file.as_ref()),
        ["zoo", "publish", target, "--key", key, ref sources @ ..] => {
            zoo::publish(target.as_ref(), Some(key.as_ref()), sources)
        }
        ["zoo", "publish", target, ref sources @ ..] => zoo::publish(target.as_ref(), None, sources),
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("xtask: {error}");
            ExitCode::FAILURE
        }
    }
}
