# SPDX-License-Identifier: Apache-2.0
#
# Toolchain file: Debian's cross compiler for 64-bit Arm, libraries from PIERCE_ARM_ROOT (a folder
# that scripts/arm.sh fills), programs run by qemu-user.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_FLAGS_INIT -Wno-psabi)  # notes on how GCC 9 passed a pair of boxes
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES PIERCE_ARM_ROOT)
set(CMAKE_FIND_ROOT_PATH ${PIERCE_ARM_ROOT} /usr/aarch64-linux-gnu)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_LIBDIR} ${PIERCE_ARM_ROOT}/usr/lib/aarch64-linux-gnu/pkgconfig)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${PIERCE_ARM_ROOT})
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static -L /usr/aarch64-linux-gnu)
