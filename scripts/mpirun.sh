# run_on_ranks N COMMAND…: starts N ranks on this machine, as root too, with more ranks than cores if need be. The one place that says how.
run_on_ranks() {
  local n=$1
  shift
  OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 \
    mpirun --oversubscribe --bind-to none --mca btl_base_warn_component_unused 0 -np "$n" "$@"
}
