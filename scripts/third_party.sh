#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# Makes the sources in third_party/ anew from Debian 12's packages, unchanged, and shows what is
# different from what is committed: nothing. Needs a network and apt-get; installs nothing.
#
#   scripts/third_party.sh
set -euo pipefail
cd "$(dirname "$0")/../third_party"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg]" \
  "http://deb.debian.org/debian bookworm main" >"$work/sources.list"
mkdir -p "$work/lists/partial"
chmod 755 "$work"

# In $work/root: what the packages would install; in $work/highway-*: Highway's source.
(
  cd "$work"
  options=(-qq -o APT::Sandbox::User=root)
  apt-get "${options[@]}" download libboost1.81-dev=1.81.0-5+deb12u1 libcli11-dev=2.1.2+ds-1 \
    libfast-float-dev=3.9.0-1 libfmt-dev=9.1.0+ds1-2 libhwy-dev=1.0.3-3+deb12u1 \
    nlohmann-json3-dev=3.11.2-2 "libstb-dev=0.0~git20220908.8b5f1f3+ds-1"
  for package in *.deb; do dpkg-deb -x "$package" root; done
  options+=(-o "Dir::Etc::sourcelist=$work/sources.list" -o Dir::Etc::sourceparts=-
    -o "Dir::State::lists=$work/lists")
  apt-get "${options[@]}" update
  apt-get "${options[@]}" source --download-only highway=1.0.3-3+deb12u1
  tar -xzf highway_1.0.3.orig.tar.gz
)

# renew FOLDER FROM NAME...: these files and folders of FROM are all that FOLDER has, but a licence.
renew() {
  local folder=$1 from=$2
  shift 2
  find "$folder" -mindepth 1 ! -name 'LICENSE*' -delete 2>/dev/null || true
  mkdir -p "$folder"
  (cd "$from" && cp -r --parents "$@" "$OLDPWD/$folder")
  find "$folder" -type f -exec chmod 644 {} +
}
include=$work/root/usr/include
renew Boost "$include" boost/config.hpp boost/config/{helper_macros,user,workaround}.hpp \
  boost/config/detail boost/config/compiler/{clang,clang_version,gcc,visualc}.hpp \
  boost/config/platform/{linux,macos,win32}.hpp \
  boost/config/stdlib/{dinkumware,libcpp,libstdcpp3}.hpp \
  boost/multiprecision/{cpp_bin_float,cpp_int,integer,number,rational_adaptor}.hpp \
  boost/multiprecision/{cpp_bin_float,cpp_int,detail,traits}
renew CLI11 "$include" CLI
renew FastFloat "$include" fast_float
rm FastFloat/fast_float/fast_float_all.h # the others in one file
renew fmt "$include" fmt/{core,format,format-inl,ostream,ranges}.h
renew nlohmann_json "$include" nlohmann
renew stb "$include" stb/stb_image_write.h
renew hwy "$include" hwy/{base,cache_control,detect_compiler_arch,detect_targets}.h \
  hwy/{foreach_target,highway,highway_export,per_target,targets}.h \
  hwy/ops/{set_macros,shared,generic_ops,emu128,scalar,arm_neon,x86_128,x86_256,x86_512}-inl.h
cp "$work"/highway-1.0.3/hwy/{targets,per_target}.cc hwy/hwy/
git status --short .
