#!/bin/sh
# The sources are as clang-format would write them. usage: format_test.sh ROOT. Exit 77: there is no clang-format 14.
set -eu
cd "$1"
command -v clang-format >/dev/null 2>&1 || { echo "skipped: clang-format is not installed"; exit 77; }
version=$(clang-format --version)
case $version in
  *"version 14."*) ;;
  *) echo "skipped: needs clang-format 14, found: $version"; exit 77 ;;
esac
exec ./dev format --check
