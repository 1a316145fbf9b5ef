# wavetank on Debian 12, built, with pocl as its OpenCL driver:
#   docker build -t wavetank .
#   docker run --rm -v "$PWD/output:/wavetank/output" wavetank           the demo, whose bag and picture come into output/
#   docker run --rm -it wavetank bash                                    a shell in which roslaunch and rosrun know the package
FROM debian:12
WORKDIR /wavetank

# The packages first, so that a change of the sources does not install them again.
COPY .ci/apt.txt .ci/apt.txt
COPY scripts/install scripts/install
RUN scripts/install --no-tests --tools --python --surface --web && apt-get clean && rm -rf /var/lib/apt/lists/*

COPY . .
RUN scripts/build

ENV ROS_HOSTNAME=localhost
ENTRYPOINT ["/wavetank/devel/env.sh"]
CMD ["scripts/demo"]
