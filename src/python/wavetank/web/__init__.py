"""A page in the browser of a tank that runs, or of a bag.

Of a tank (live.py) or a bag (replay.py) the server (server.py) makes packets (packets.py), which lie in a mailbox for each client (mailbox.py): of pictures
only the newest, of samples all, thinned where a client is too slow (series.py). What a client asks for is checked by requests.py. static/ is the page itself.
"""
