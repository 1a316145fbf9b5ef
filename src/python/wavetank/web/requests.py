"""What a client may ask for. Whatever comes is looked at here before anything is done with it."""

import json

LONGEST = 4096  # characters


class Refused(Exception):
    """What a client asked for is not allowed; its text is one sentence."""


def flag(name, value, known):
    if not isinstance(value, bool):
        raise Refused("'%s' is true or false" % name)
    return value


def number(name, value, least, greatest):
    # the range is looked at first: it holds neither nan nor what has too many digits for a float
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not least <= value <= greatest:
        raise Refused("'%s' is a number from %g to %g" % (name, least, greatest))
    return float(value)


def time(name, value, known):
    return number(name, value, 0.0, 1e9)


def vector(name, value, known):
    if not isinstance(value, list) or len(value) != 3:
        raise Refused("'%s' is a list of three numbers" % name)
    return [number(name, part, -1e9, 1e9) for part in value]


def one_of(names, what):
    def check(name, value, known):
        allowed = known.get(names, [])
        if not isinstance(value, str) or value not in allowed:
            raise Refused("'%s' is %s: %s" % (name, what, ", ".join(allowed) or "there is none"))
        return value

    return check


WATER = one_of("waters", "what of the water is shown")
SEEN = {"seen": {}}  # a picture has been drawn
LIVE = {
    **SEEN,
    "pause": {"value": flag},
    "step": {},
    "reset": {},
    "push": {"body": one_of("bodies", "a free body"), "force": vector, "torque": vector},
    "show": {"water": WATER},
}
REPLAY = {**SEEN, "frame": {"time": time, "water": WATER}}


def strictly(pairs):
    keys = dict(pairs)
    if len(keys) != len(pairs):
        raise Refused("a request has every key once")
    return keys


def unknown_number(text):
    raise Refused("'%s' is no number" % text)


def read_request(text, allowed, known):
    """The request as a dictionary: {"do": word, keys of the word}. text: what came. allowed: LIVE or REPLAY. known: names by "bodies" and "waters". Raises
    Refused."""
    if not isinstance(text, str):
        raise Refused("a request is text, not binary")
    if len(text) > LONGEST:
        raise Refused("a request has at most %d characters" % LONGEST)
    try:
        request = json.loads(text, object_pairs_hook=strictly, parse_constant=unknown_number)
    except (ValueError, RecursionError):
        raise Refused("a request is JSON")
    if not isinstance(request, dict) or not isinstance(request.get("do"), str) or request["do"] not in allowed:
        raise Refused("a request is an object whose 'do' is one of %s" % ", ".join(allowed))
    keys = allowed[request["do"]]
    if set(request) != {"do", *keys}:
        raise Refused("'%s' has the keys %s and no other" % (request["do"], ", ".join(["do", *keys])))
    return {"do": request["do"], **{name: check(name, request[name], known) for name, check in keys.items()}}


def origin_is_ours(origin, host, names):
    """Whether a page of this server asks: its Origin is the host that it was asked by, and that is one of the names (or addresses) by which it may be. A
    page elsewhere could have its own name lead here."""
    if not origin or not host:
        return False
    return origin.lower() == "http://" + host.lower() and host_name(host) in names


def host_name(host):
    """Without the port."""
    host = host.lower()
    if host.startswith("["):
        return host[1 : host.find("]")]
    return host.rpartition(":")[0] if ":" in host else host
