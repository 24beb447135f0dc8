# shellcheck shell=sh
# How far long commands are: no terminal stays silent for more than ten seconds. Sourced by ./rumba, which has say().

beat=8 # [s] after which a command is spoken of again
mark=$(printf '\001')

# Runs a command, shows how far it is and for how long it has run, keeps its output in the file $log, and returns its
# exit code. USUALLY says how long it takes as a rule.
with_progress() { # TITLE USUALLY COMMAND ...
    title=$1 usually=$2
    shift 2
    begin
    [ -t 1 ] || say "$title"
    with_beats "$beat" "$@" | {
        redraw
        while IFS= read -r line; do
            case $line in
                'exit code:'*) [ ! -t 1 ] || printf '\r\033[K'; exit "${line#*:}" ;;
                *"$mark")
                    take_time
                    [ -t 1 ] || say "$(progress)"
                    line=${line%"$mark"}
                    [ -z "$line" ] || echo "$line" >>"$log" ;;
                # Packages are downloaded first, and then installed.
                dlstatus:*:*:*) reach 0 30 "${line#*:*:}"; doing=${line##*:} ;;
                pmstatus:*:*:*) reach 30 100 "${line#*:*:}"; doing=${line##*:} ;;
                # Sphinx reads all pages, and then writes them.
                reading*\[*%\]*) reach 0 50 "${line#*[}"; doing=${line#*] }; echo "$line" >>"$log" ;;
                writing*\[*%\]*) reach 50 100 "${line#*[}"; doing=${line#*] }; echo "$line" >>"$log" ;;
                # The last step of make, which compiles the planner, takes nearly half of the time.
                *\[*%\]*) reach 0 60 "${line#*[}"; doing=${line#*] }; echo "$line" >>"$log" ;;
                *) echo "$line" >>"$log"; continue ;;
            esac
            redraw
        done
    }
}

# Runs a command whose output is shown, and says how long it has run whenever it is silent; returns its exit code.
with_voice() { # TITLE USUALLY COMMAND ...
    title=$1 usually=$2
    shift 2
    begin
    say "$title${usually:+, usually $usually}"
    # Only the second beat of a silence is sure to be one.
    with_beats $((beat / 2)) "$@" | {
        is_silent=
        while IFS= read -r line; do
            case $line in
                'exit code:'*) exit "${line#*:}" ;;
                "$mark")
                    take_time
                    [ -z "$is_silent" ] || say "$(progress)"
                    is_silent=yes ;;
                *) printf '%s\n' "${line%"$mark"}"; is_silent= ;;
            esac
        done
    }
}

# The output of a command, a line of one mark after each beat, and the exit code as the last line.
with_beats() { # SECONDS COMMAND ...
    pause=$1
    shift
    # Nothing may hold the lock of ./rumba, which is file 9, after the command has ended.
    while sleep "$pause"; do echo "$mark"; done 9<&- 2>/dev/null &
    beating=$!
    if "$@" 2>&1 </dev/null; then code=0; else code=$?; fi
    kill "$beating" 2>/dev/null || true
    echo "exit code:$code"
}

begin() {
    begun=$(date +%s) elapsed=0:00 percent='' doing=''
}

reach() { # FIRST LAST PERCENT: of a part of the work, which goes from FIRST % to LAST % of all
    of_part=${3%%[.:%]*}
    case $of_part in *[!0-9\ ]* | '') return 0 ;; esac # no number
    percent=$(($1 + ($2 - $1) * of_part / 100))
}

take_time() { # since $begun, as minutes:seconds, in $elapsed
    seconds=$(($(date +%s) - begun))
    elapsed=$((seconds / 60)):$(printf %02d $((seconds % 60)))
}

progress() { # one line: what is done, how far it is, for how long, and what exactly is at work
    printf '%s%s, %s%s%s' "$title" "${percent:+ $percent %}" "$elapsed" "${usually:+ (usually $usually)}" \
        "${doing:+: $doing}"
}

redraw() { # on a terminal, over the line before; it fits 80 columns
    [ ! -t 1 ] || printf '\r\033[Krumba: %.72s' "$(progress)"
}
