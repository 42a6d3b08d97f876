# SPDX-License-Identifier: MIT
from SCons.Script import AlwaysBuild, Default, DefaultEnvironment

env = DefaultEnvironment()
env.Replace(AR="ar", CC="gcc", CXX="g++", RANLIB="ranlib", PROGNAME="program")
program = env.BuildProgram()
AlwaysBuild(env.Alias("exec", program, env.VerboseAction("$SOURCE", "Executing $SOURCE")))
Default(program)
