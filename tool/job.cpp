// SPDX-License-Identifier: Apache-2.0
//
// pierce job: many rays in chunks, each cast by whoever comes along. The commands are in job/.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>
#include <memory>

#include "cast_options.h"
#include "command.h"
#include "job/job_commands.h"
#include "loaded_scene.h"

namespace pierce::tool {
namespace {

struct Options {
  CreateOptions create;
  RunOptions run;
  VerifyOptions verify;
  StatusOptions status;
  MergeOptions merge;
};

void add_folder(CLI::App& app, std::string& folder) {
  app.add_option("DIR", folder, "The job's folder")->required();
}

void add_create(CLI::App& job, CreateOptions& options) {
  CLI::App* sub = job.add_subcommand("create", "Make the folder of a job");
  add_mesh_arguments(*sub, options.meshes);
  sub->add_option("--job", options.folder, "The job's folder, which is made")
      ->type_name("DIR")
      ->required();
  add_ray_options(*sub, options.source);
  add_query_options(*sub, options);
  sub->add_option("--chunk", options.chunk, "Rays a chunk, rounded up to a multiple of eight")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 32).description("N"))
      ->default_str("4194304");
  add_precision_option(*sub, options.precision);
  add_threads_option(*sub, options.threads);
  add_quiet_flag(*sub, options);
}

void add_run(CLI::App& job, RunOptions& options) {
  CLI::App* sub = job.add_subcommand("run", "Cast the chunks that are not there yet");
  add_folder(*sub, options.folder);
  sub->add_option("--part", options.part,
                  "Of n workers the i-th, from 0: chunks i, i + n, ...; default: what Open MPI, "
                  "MPICH or Slurm say in their environment variables, else all")
      ->type_name("i/n");
  add_threads_option(*sub, options.threads);
  sub->add_flag("--quiet", options.quiet, "Print no summary");
  sub->add_flag("--json", options.json, "Print a line of JSON for every chunk that is cast");
}

void add_verify(CLI::App& job, VerifyOptions& options) {
  CLI::App* sub = job.add_subcommand("verify", "Cast random chunks anew and compare the bytes");
  add_folder(*sub, options.folder);
  sub->add_option("--chunks", options.chunks, "How many")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000'000}).description("N"))
      ->default_str("10");
  sub->add_flag("--all", options.all, "All that are there");
  sub->add_option("--seed", options.seed, "Which ones; default: others each time");
  add_threads_option(*sub, options.threads);
  sub->add_flag("--quiet", options.quiet, "Print no summary");
}

int dispatch(const CLI::App& app, const Options& options) {
  const std::string name = app.get_subcommands().front()->get_name();
  if (name == "create") return create_job(options.create);
  if (name == "run") return run_job(options.run);
  if (name == "verify") return verify_job(options.verify);
  if (name == "status") return status_of_job(options.status);
  return merge_job(options.merge);
}

}  // namespace

Command add_job(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("job", "Cast many rays in chunks: stop, resume, share out");
  const auto options = std::make_shared<Options>();
  sub->require_subcommand(1);
  add_create(*sub, options->create);
  add_run(*sub, options->run);
  CLI::App* status = sub->add_subcommand("status", "Tell how far a job has come");
  add_folder(*status, options->status.folder);
  status->add_flag("--json", options->status.json, "Print one JSON object");
  add_verify(*sub, options->verify);
  CLI::App* merge = sub->add_subcommand("merge", "Make one file of all chunks");
  add_folder(*merge, options->merge.folder);
  merge->add_option("--out", options->merge.out, "The file, .npy")->required();
  merge->add_flag("--quiet", options->merge.quiet, "Print no summary");
  sub->footer(
      "Examples:\n"
      "  pierce job create city.pierce --sphere 1000000000 --reduce triangles --job seen\n"
      "  pierce job run seen\n"
      "  pierce job status seen\n"
      "  pierce job verify seen\n"
      "  pierce job merge seen --out seen.npy\n"
      "  mpirun -n 4 pierce job run seen --threads 1\n"
      "A job is a folder. Chunks that are there are not cast again, so a run that was killed, by\n"
      "whatever, is run again; any number of runs may share the folder at a time. The bytes are\n"
      "those of `pierce cast`, whoever cast them. docs/large_jobs.md has more.");
  return {sub, [sub, options] { return dispatch(*sub, *options); }};
}

}  // namespace pierce::tool
