#!/usr/bin/env bash
# Runs a command that has to end with a status: expect_status.sh STATUS COMMAND...
expected=$1
shift
"$@"
got=$?
[ "$got" = "$expected" ] || { echo "expected status $expected, got $got"; exit 1; }
