# SPDX-License-Identifier: MIT
# Plugs a generated controller into the slot: awk -v model=NAME -v rate=HZ -f adapter.awk NAME.h
#
# Reads the header that the generator wrote: its entry points and its structs. Understood are
#   nonreusable function                NAME_step(void), NAME_U, NAME_Y
#   reusable function, root-level I/O   part of model data structure   NAME_step(RT_MODEL *)
#                                       structure reference            NAME_step(RT_MODEL *, ExtU *,
#                                       ExtY *)
#                                       individual arguments           NAME_step(RT_MODEL *, real_T
#                                       U_q, ..., real_T *Y_f)
# rate: the model's fixed step, as Hz, a whole number; empty where it knows none. map: "theirs=ours
# ..." for ports that are named otherwise. Exit status 2, after a line that says which model, what,
# and what to do.

function fail(text) { print model ".h: " text > "/dev/stderr"; failed = 1; exit 2 }
function trim(s) { gsub(/^ +| +$/, "", s); return s }
# The last word of a declarator, and the text before it.
function name_of(s) { match(s, /[A-Za-z_0-9]+$/); return substr(s, RSTART) }
function type_of(s) { return trim(substr(s, 1, length(s) - length(name_of(s)))) }
function ours(port) { return port in other ? other[port] : port }

BEGIN {
    n = split(map, pair, " ")
    for (i = 1; i <= n; i++) { split(pair[i], side, "="); other[side[1]] = side[2] }
    if (rate != "" && rate !~ /^[1-9][0-9]*$/) {
        fail("MODEL_RATE=" rate ": give a whole number of Hz, or leave it out") }
}

# A macro goes on behind a backslash.
{ sub(/\r$/, ""); macro = macro || $0 ~ /^[ \t]*#/;
    if (!macro) { text = text " " $0 } macro = macro && $0 ~ /\\$/ }

# "typedef struct { fields } TYPE;", "struct TAG { fields };" and declarations, which end in ";".
END {
    if (failed) { exit 2 }
    while (match(text, /\/\*[^*]*\*+([^\/*][^*]*\*+)*\//)) {
        text = substr(text, 1, RSTART - 1) " " substr(text, RSTART + RLENGTH) }
    gsub(/[ \t]+/, " ", text)
    gsub(/extern "C" \{/, "", text)
    while (match(text, /[;{]/)) {
        head = trim(substr(text, 1, RSTART - 1))
        open = substr(text, RSTART, 1) == "{"
        text = substr(text, RSTART + 1)
        if (!open) { declare(head); continue }
        depth = 1; body = ""
        while (depth > 0 && match(text, /[{}]/)) {
            depth += substr(text, RSTART, 1) == "{" ? 1 : -1
            body = body substr(text, 1, RSTART - (depth == 0))
            text = substr(text, RSTART + 1)
        }
        match(text, /;/)
        tail = trim(substr(text, 1, RSTART - 1))
        text = substr(text, RSTART + 1)
        fields[tail != "" ? tail : name_of(head)] = body
    }
    if (!(model "_step" in proto)) {
        fail("no " model "_step(): wanted is a single-rate model with one output/update " \
             "function, called as the folder (MODEL_NAME=NAME)")
    }
    if (!(model "_initialize" in proto)) { fail("no " model "_initialize()") }
    write()
}

function declare(s,    f, args, at) {
    gsub(/\*/, " * ", s); gsub(/ +/, " ", s)
    at = index(s, "(")
    if (at) {
        f = name_of(trim(substr(s, 1, at - 1)))
        args = substr(s, at + 1)
        sub(/\).*$/, "", args)
        proto[f] = trim(args)
    } else if (s ~ /^extern /) {
        sub(/^extern /, "", s)
        if (s !~ /\[/) { global[name_of(s)] = type_of(s) }
    }
}

# The fields of a struct type into field[], kind[]: their number. Of outputs only f is wired: others
# may be anything.
function take_fields(type, outputs,    n, i, part, count, f) {
    if (!(type in fields)) { fail("no struct " type) }
    n = split(fields[type], part, ";")
    count = 0
    for (i = 1; i <= n; i++) {
        f = trim(part[i])
        if (f == "") { continue }
        if (outputs && sub(/ *\[.*$/, "", f) && ours(name_of(f)) != "f") { continue }
        if (trim(part[i]) ~ /[\[{}(]/) {
            fail(type ": \"" trim(part[i]) "\": only scalars can be wired: one finger, " \
                 "one value a port")
        }
        field[++count] = name_of(f); kind[count] = type_of(f)
    }
    return count
}

# A quantity in an integer would lose its fraction, or is scaled by what no header says.
function want_real(port, type) {
    if (type ~ /^(const )?(u?int[0-9]*_T|u?int[0-9]+_t|s?u?fix.*_T|byte_T|boolean_T|char_T)$/ ||
        type ~ /^(const )?.*(char|short|int|long)$/) {
        fail(port ": " type ": wanted is real_T or real32_T, the value in SI; c and on alone may " \
             "be integers")
    }
}

# One input; t and T are the adapter's own.
function wire(target, type, port,    value) {
    port = ours(port)
    if (port != "c" && port != "on" && type != "boolean_T") { want_real(port, type) }
    if (port == "t") { value = "real_t_s()" }
    else if (port == "T") { value = "real_T_s()"; timed = 1 }
    else { value = "real_in(" ins + 0 ")"; input[ins++] = port }
    sets = sets "    " target " = " (type == "boolean_T" ? value " != 0" : "(" type ")" value) ";\n"
}

function forced(source, port, type) {
    if (ours(port) != "f") { return }
    want_real(port, type)
    if (force != "" && force != source) {
        fail(port ": a second outport for f: one force a finger") }
    force = source
}

function wire_struct(in_type, in_name, out_type, out_name,    n, i) {
    if (in_type != "") { n = take_fields(in_type, 0); for (i = 1; i <= n; i++) {
        wire(in_name field[i], kind[i], field[i]) } }
    n = take_fields(out_type, 1)
    for (i = 1; i <= n; i++) { forced(out_name field[i], field[i], kind[i]) }
}

# The port's own name, without what the generator puts before it.
function port_of(s) { sub("^(" model "_|rt|arg_)?[UY]_", "", s); sub(/^arg_/, "", s); return s }

# What a reusable model keeps, ours to provide: its struct, and one of each that this points to.
function own_memory(rtm,    n, i, part, f, type) {
    statics = "static " rtm " rtm;\n"
    clears = "    memset(&rtm, 0, sizeof rtm);\n"
    memory = keeps_time(tag_of(rtm))
    n = split(fields[tag_of(rtm)], part, ";")
    for (i = 1; i <= n; i++) {
        f = trim(part[i]); gsub(/\*/, " * ", f); gsub(/ +/, " ", f)
        memory = memory || (f != "" && type_of(f) in fields)
        if (f !~ /\*/ || f ~ /[\[{}(]/ || f ~ /char_T/) { continue }
        type = type_of(f); sub(/ \*.*$/, "", type); sub(/^const /, "", type)
        f = name_of(f)
        if (global[model "_P"] == type) { packs = packs "    rtm." f " = &" model "_P;\n";
            continue }
        if (!(type in fields)) { fail("struct tag_RTM_" model "_T: " f ": no struct " type) }
        statics = statics "static " type " its_" f ";\n"
        clears = clears "    memset(&its_" f ", 0, sizeof its_" f ");\n"
        packs = packs "    rtm." f " = &its_" f ";\n"
        of_type[type] = "its_" f
        memory = memory || f !~ /^(inputs|outputs)$/
    }
}

# The model counts its steps, as time.
function keeps_time(tag) { return fields[tag] ~ /[^A-Za-z_0-9](Timing|clockTick[A-Z0-9]*) *;/ }

function tag_of(rtm) { if (rtm in fields) { return rtm } sub(/^RT_MODEL_/, "tag_RTM_", rtm);
    return rtm }

# Arguments of an entry point of a reusable model.
function pass(args,    n, i, arg, call, type, name) {
    n = split(args, arg, ",")
    call = ""
    for (i = 1; i <= n; i++) {
        type = type_of(trim(arg[i])); name = name_of(trim(arg[i]))
        sub(/ const$/, "", type); sub(/ \*$/, "", type); sub(/^const /, "", type)
        if (type ~ /^RT_MODEL_|^rtModel_/) { call = call ", &rtm"; continue }
        if (!(type in fields) && arg[i] !~ /\*/) { wire_value(type, name); call = call ", in_" name;
            continue }
        if (!(type in fields)) { # a scalar that comes out
            if (!(name in declared)) { statics = statics "static " type " out_" name ";\n" }
            declared[name] = 1
            forced("out_" name, port_of(name), type); call = call ", &out_" name
            continue
        }
        if (!(type in of_type)) {
            of_type[type] = "its_" name
            memory = memory || type !~ /^(ExtU|ExtY|ExternalInputs|ExternalOutputs|P|Parameters)_/
            statics = statics "static " type " its_" name ";\n"
            clears = clears "    memset(&its_" name ", 0, sizeof its_" name ");\n"
        }
        call = call ", &" of_type[type]
    }
    return substr(call, 3)
}

function wire_value(type, name) {
    if (name in declared) { return }
    declared[name] = 1
    statics = statics "static " type " in_" name ";\n"
    wire("in_" name, type, port_of(name))
}

function write(    args, i, n, u, y, call, start, stop, error, ins_struct, outs_struct) {
    args = proto[model "_step"]
    if (args == "void" || args == "") {
        if (!(model "_Y" in global)) {
            fail("no " model "_Y: root-level I/O wanted is a structure")
        }
        wire_struct(global[model "_U"], model "_U.", global[model "_Y"], model "_Y.")
        memory = keeps_time("tag_RTM_" model "_T") || keeps_time("tag_RTM_" model)
        n = split("B X DW DWork PrevZCX U Y", kind, " ")
        for (i = 1; i <= n; i++) {
            y = model "_" kind[i]
            if (!(y in global) || global[y] ~ /const/) { continue }
            clears = clears "    memset(&" y ", 0, sizeof " y ");\n"
            memory = memory || kind[i] !~ /^[UY]$/
        }
        call = start = stop = ""
        error = (model "_M") in global ? model "_M->errorStatus" : ""
    } else {
        u = args; sub(/,.*$/, "", u)
        u = type_of(trim(u)); sub(/ \*.*$/, "", u)
        if (!(tag_of(u) in fields)) {
            fail(model "_step(" args "): not understood: wanted is void, or RT_MODEL_" model \
                 "_T *const first")
        }
        own_memory(u)
        call = pass(args); start = pass(proto[model "_initialize"])
        stop = (model "_terminate") in proto ? pass(proto[model "_terminate"]) : ""
        for (y in of_type) { if (y ~ /^(ExtU|ExternalInputs)_/) {
            ins_struct = y } else if (y ~ /^(ExtY|ExternalOutputs)_/) { outs_struct = y } }
        if (outs_struct != "") { wire_struct(ins_struct, of_type[ins_struct] ".", outs_struct,
            of_type[outs_struct] ".") }
        error = "rtm.errorStatus"
    }
    if (error != "" && fields["tag_RTM_" model "_T"] fields["tag_RTM_" model] !~ /errorStatus/) {
        error = "" }
    if (force == "") {
        fail("no outport f, the force asked for in N: name it so, or MODEL_MAP=\"THEIRS=f\"")
    }
    if (ins > 32) { fail(ins " inports: at most 32") }
    if (rate == "" && memory && !timed) {
        fail("it remembers, so it was made for one rate: say which, MODEL_RATE=HZ, or give it an " \
             "inport T, the period in s")
    }

    print "/* " model " in the slot, made from its header. */"
    print "#include \"" model ".h\"\n\n#include \"slot_real.h\"\n\n#include <string.h>\n"
    print statics
    printf "static const char *const input[] = {"
    for (i = 0; i < ins; i++) { printf "\"%s\", ", input[i] }
    print "0};\n"
    print "static int init(const struct slot_wire *wire, struct exh_period T)\n{"
    print "    real_wire(wire, " ins + 0 ", T);"
    printf "%s%s", clears, packs
    print "    " model "_initialize(" start ");\n    return 0;\n}\n"
    print "static int32_t step(void)\n{"
    printf "%s", sets
    print "    " model "_step(" call ");"
    print "    return " (error == "" ? "" : error " ? real_none() : ") \
          "real_out((double)" force ");\n}\n"
    print "static void terminate(void)\n{"
    if ((model "_terminate") in proto) { print "    " model "_terminate(" stop ");" }
    print "}\n"
    print "const struct slot slot = {\"" model "\", " rate + 0 "u, " ins + 0 \
          ", input, init, step, terminate};"
}
