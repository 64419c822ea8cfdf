# The one place that says how the tests start several ranks: as root too, and with more ranks and threads than cores, which must not
# spin while they wait for each other (2 x 2 on 2 cores: 300 s and more against 25 s).
set(TROCAR_MPIRUN mpirun --allow-run-as-root --oversubscribe --bind-to none)
