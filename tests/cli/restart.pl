#!/usr/bin/env perl
# SPDX-License-Identifier: LGPL-2.1-or-later
# Usage: restart.pl BILLET [LAUNCHER...]      in an empty current folder; LAUNCHER is mpirun with its option -n
#
# Runs of block.prm and impact.prm that write checkpoints, go on from them, are stopped by signals; checkpoints that must be
# refused; a disk that is full.
use strict;
use warnings;
use File::Basename;
use File::Copy;
use File::Path;
use List::Util qw(max);

my $here = dirname(__FILE__);
require "$here/edit_scene.pl";

my ($billet, @launcher) = @ARGV;
my $block = read_text("$here/block.prm");
my $impact = read_text("$here/impact.prm");
my ($n_checks, $n_failed) = (0, 0);
enter_folder();

sub check
{
  my ($name, $claim) = @_;
  my $fault = eval { $claim->() } // $@;
  chomp $fault;
  print "$name: ", ($fault eq '' ? "ok\n" : "FAILED: $fault\n");
  ++$n_checks;
  ++$n_failed if $fault ne '';
}

sub is { my ($what, $found, $expected) = @_; return $found eq $expected ? '' : "$what is '$found', not '$expected'" }

# Writes the scene, edited. Checkpoints are asked for by a subsection of its output.
sub scene
{
  my ($name, $base, $edits, $checkpoints) = @_;
  my ($text) = edit($base, $edits);
  ($text) = edit($text, "Output: + subsection Checkpoint\\n$checkpoints\\nend") if $checkpoints;
  write_text($name, $text);
}

sub on { my ($ranks, @arguments) = @_; return (($ranks > 1 ? (@launcher, $ranks) : ()), $billet, @arguments) }

# Runs; dies unless the exit code is this one. Returns what it printed.
sub runs
{
  my ($expected, @command) = @_;
  my ($code, $output, $errors) = run(@command);
  die "exit code $code, not $expected\n$output$errors" unless $code == $expected || ($code == 7 && $expected == 0); # 7: a target error is missed
  return $output . $errors;
}

sub copy_folder
{
  my ($from, $to) = @_;
  mkdir $to or die "$to: $!\n";
  copy($_, $to) or die "$_: $!\n" for glob "$from/*";
}

sub rows { my ($file) = @_; return map { [split /,/] } split /\n/, read_text($file) }

# Each number relative to the largest in its column, of those columns.
sub largest_difference
{
  my ($a, $b, @names) = @_;
  my @a = rows($a);
  my @b = rows($b);
  return @a . ' lines, not ' . @b unless @a == @b;
  my ($worst, $where) = (0, '');
  for my $c (grep { my $name = $a[0][$_]; grep { $name =~ /$_/ } @names } 0 .. $#{$a[0]})
  {
    my $size = max(1e-9, map { abs $a[$_][$c] } 1 .. $#a);
    for my $r (1 .. $#a)
    {
      my $difference = abs($a[$r][$c] - $b[$r][$c]) / $size;
      ($worst, $where) = ($difference, $a[0][$c]) if $difference > $worst;
    }
  }
  return $worst <= 1e-8 ? '' : "$where differs by $worst";
}

# --- going on ------------------------------------------------------------------------------------------------------

my @same = ('history.csv', 'scene.pvd');
my %base = (block => $block, impact => $impact, aimed => $block, drop => read_text("$here/drop.prm"),
  edge => read_text("$here/edge.prm"));
my %every = (block => 'set Every steps = 1', impact => 'set Interval = 0.1e-3', aimed => 'set Every steps = 1',
  drop => 'set Every steps = 1', edge => 'set Interval = 20e-6');
# With a target error, what was measured so far goes on, too.
my %extra = (block => '', edge => '', impact => ' & Output: Interval = 0.1e-3', drop => ' & Target error = 1 % & Time stepping: End time = 0.1e-3 & + subsection Solver\n set Force tolerance = 1e-10\nend',
  aimed => ' & Target error = 1 % & Time stepping: - Initial step & Time stepping: - Largest step & Solver: - Force tolerance & Solver: - Energy tolerance');
for my $which ('block', 'impact', 'aimed', 'drop', 'edge')
{
  for my $ranks (1, @launcher ? 2 : ())
  {
    my $folder = "$which$ranks";
    scene("$folder.prm", $base{$which}, "Output: Folder = $folder$extra{$which}", "$every{$which}\\nset Keep = 100");
    my @checkpoints;
    check "$which on $ranks writes checkpoints", sub {
      runs(0, on($ranks, "$folder.prm"));
      @checkpoints = sort glob "$folder/checkpoint_*.h5";
      return @checkpoints > 3 ? '' : 'only ' . @checkpoints;
    };
    copy_folder($folder, "$folder.whole");
    for my $from (0, 2, $#checkpoints - 1)
    {
      check "$which on $ranks goes on from $from, nothing differs", sub {
        runs(0, on($ranks, '--restart', $checkpoints[$from], "$folder.prm"));
        my @faults = map { read_text("$folder/$_") eq read_text("$folder.whole/$_") ? () : "$_ differs" } @same;
        return join ', ', @faults;
      };
    }
  }
  check "$which on 2, then on 1", sub {
    copy_folder("${which}2.whole", "${which}3");
    scene('other_ranks.prm', $base{$which}, "Output: Folder = ${which}3$extra{$which}", "$every{$which}\\nset Keep = 100");
    runs(0, on(1, '--restart', "${which}3/checkpoint_00001.h5", 'other_ranks.prm'));
    my $forces = $which eq 'drop' ? 'force_[yz]' : 'force'; # along x there is nothing but round-off
    return largest_difference("${which}2.whole/history.csv", "${which}3/history.csv", '^time$', $forces, 'travel');
  } if @launcher;
}
for my $types (['double', 'float'], ['float', 'double'])
{
  my ($from, $to) = @$types;
  check "begun in $from, goes on in $to", sub {
    scene("$from.prm", $impact, "Output: Folder = in_$from & Output: Interval = 0.1e-3 & Explicit dynamics: Number type = $from",
          'set Interval = 0.1e-3\\nset Keep = 100');
    runs(0, on(1, "$from.prm"));
    scene("to_$to.prm", $impact, "Output: Folder = to_$to & Explicit dynamics: Number type = $to", '');
    my $text = runs(0, on(1, '--restart', "in_$from/checkpoint_00002.h5", "to_$to.prm"));
    my @whole = rows("in_$from/history.csv");
    my @rest = rows("to_$to/history.csv");
    return ($text =~ /^note\[resumed\]: Resumed from in_$from/m ? '' : "says $text") || is('end', $rest[-1][1], $whole[-1][1]);
  };
}
check 'a target error after a run without one: from then on', sub {
  scene('aimed_late.prm', $block, "Output: Folder = aimed_late$extra{aimed}");
  my $text = runs(0, on(1, '--restart', 'block1.whole/checkpoint_00003.h5', 'aimed_late.prm'));
  my ($time) = $text =~ /^note\[resumed\]: Resumed from .* at time (\S+)\.$/m;
  return $text =~ /^note\[error-estimate\]: Estimated error [\d.e-]+ % of the forces, target 1 %, from time \Q$time\E on:/m
    && read_text('aimed_late/error_estimate.csv') =~ /^since,\Q$time\E$/m ? '' : "says $text";
};
check 'which the next one goes on with', sub {
  scene('aimed_late.prm', $block, "Output: Folder = aimed_late$extra{aimed}", 'set Every steps = 1\\nset Keep = 100');
  my $text = runs(0, on(1, '--restart', 'block1.whole/checkpoint_00002.h5', 'aimed_late.prm'));
  my ($told) = $text =~ /^(note\[error-estimate\]: .*Newton iterations), /m;
  my @checkpoints = sort glob 'aimed_late/checkpoint_*.h5';
  my ($again) = runs(0, on(1, '--restart', $checkpoints[1], 'aimed_late.prm')) =~ /^(note\[error-estimate\]: .*Newton iterations), /m;
  return $told =~ /from time \S+ on/ ? is('told', $again, $told) : "says $told";
};
check 'a tool that a force drives, with an account of its travel', sub {
  my $edits = "$extra{aimed} & Motion: Translation = 0 ; 0 ; 0 & Motion: Force = 40*t & Motion: Force direction = 0, 0, -1";
  (my $named = $block) =~ s/subsection die$/subsection die\/left/m;
  $named =~ s/= die$/= die\/left/m;
  scene('driven.prm', $named, "Output: Folder = driven$edits", 'set Every steps = 1\\nset Keep = 100');
  my ($told) = runs(0, on(1, 'driven.prm')) =~ /^(note\[error-estimate\]: .*Newton iterations), /m;
  my @checkpoints = sort glob 'driven/checkpoint_*.h5';
  my ($again) = runs(0, on(1, '--restart', $checkpoints[2], 'driven.prm')) =~ /^(note\[error-estimate\]: .*Newton iterations), /m;
  return $told =~ /of the travel of 'die\/left'/ ? is('told', $again, $told) : "says $told";
};
check 'HDF5 pictures go on', sub {
  scene('hdf5.prm', $block, 'Output: Folder = hdf5 & Output: Format = hdf5', 'set Every steps = 2');
  runs(0, on(1, 'hdf5.prm'));
  my $index = read_text('hdf5/fields.xdmf');
  my ($first) = sort glob 'hdf5/checkpoint_*.h5';
  runs(0, on(1, '--restart', $first, 'hdf5.prm'));
  return read_text('hdf5/fields.xdmf') eq $index ? '' : 'fields.xdmf differs';
};
check 'two stay', sub {
  my @files = glob 'hdf5/checkpoint_*';
  return is('number', scalar @files, 2);
};
check 'the scene names its checkpoint; other steps, another folder', sub {
  scene('named.prm', $block, 'Output: Folder = named & Time stepping: Initial step = 0.05 & + subsection Restart\n'
      . 'set File = block1.whole/checkpoint_00001.h5\nend');
  my $text = runs(0, on(1, 'named.prm'));
  my @rows = rows('named/history.csv');
  my @before = rows('block1.whole/history.csv');
  return ($text =~ m{^note\[resumed\]: Resumed from .*checkpoint_00001.h5 at time $before[2][1]\.$}m ? '' : "says $text")
    || is('first step', sprintf('%.6g', $rows[1][1] - $before[2][1]), '0.05') || is('end', $rows[-1][1], 1);
};
check 'later than the end', sub {
  my ($last) = reverse sort glob 'block1.whole/checkpoint_*.h5';
  scene('later.prm', $block, 'Output: Folder = later & Time stepping: End time = 1.2');
  runs(0, on(1, '--restart', $last, 'later.prm'));
  my @rows = rows('later/history.csv');
  return is('end', $rows[-1][1], 1.2);
};

# --- from one method to the other ------------------------------------------------------------------------------------

my $no_density = 'slab / Material: - Density & block / Material: - Density';
my $static = 'block: - Element & block: - Initial velocity & block / Loads: delete & Tools: delete & Contact pairs: delete'
  . " & $no_density & Time stepping: - Scheme & Time stepping: End time = 1 & Explicit dynamics: delete"
  . ' & block: + subsection Supports\n subsection top\n set Boundary ids = 5\n end\nend';
check 'explicit, then quasi-static without tools', sub {
  scene('spring.prm', $impact, "$static & Output: Folder = spring");
  my ($last) = reverse sort glob 'impact1.whole/checkpoint_*.h5';
  my $text = runs(0, on(1, '--restart', $last, 'spring.prm'));
  return ($text =~ /without tool 'hammer', without contact pair 'hammer on block', without contact pair 'block on slab'/ ? ''
      : "says $text") || ($text =~ / The kinetic energy there, \d\S*, is dropped/m ? '' : "says $text")
    || ($text =~ / Forces out of balance, .* % of those in the scene, fade until time 1\.$/m ? '' : "says $text");
};
check 'quasi-static, then explicit, into the same folder', sub {
  scene('first.prm', $block, 'Output: Folder = both', 'set Every steps = 1');
  runs(0, on(1, 'first.prm'));
  my ($last) = reverse sort glob 'both/checkpoint_*.h5';
  scene('then.prm', $block, 'Output: Folder = both & Output: Every steps = 0 & Material: Density = 1e-6 & Solver: delete'
      . ' & Time stepping: Scheme = explicit & Time stepping: - Initial step & Time stepping: - Largest step'
      . ' & Time stepping: End time = 1.0001');
  runs(0, on(1, '--restart', $last, 'then.prm'));
  my @kept = rows('both/history_until_1.csv');
  my @now = rows('both/history.csv');
  return is('kept until', $kept[-1][1], 1) || is('begins', $now[1][1], 1);
};

# --- signals ---------------------------------------------------------------------------------------------------------

# Starts the command, sends the signal once the file is there and has some lines, and returns what run() returns.
sub signalled
{
  my ($signal, $file, @command) = @_;
  my $pid = fork() // die "fork: $!\n";
  if (!$pid)
  {
    open STDIN,  '<', '/dev/null';
    open STDOUT, '>', '../signal.stdout' or die;
    open STDERR, '>&', \*STDOUT or die;
    exec @command or die;
  }
  my $n = 0;
  select undef, undef, undef, 0.05 until ++$n > 1200 || (-e $file && (() = read_text($file) =~ /\n/g) > 3);
  kill $signal, $pid;
  waitpid $pid, 0;
  return ($? & 127 ? 128 + ($? & 127) : $? >> 8, read_text('../signal.stdout'));
}
# Long enough to be stopped: about a second and a half.
my $long = 'slab / Mesh: Arguments = 16, 16, 8 : 0, 0, -1 : 2, 2, 0 : true & Output: History interval = 1e-6 & Time stepping:'
  . ' End time = 0.4e-3';
for my $case (['TERM', 1], ['INT', 1], @launcher ? ['USR1', 2] : ())
{
  my ($signal, $ranks) = @$case;
  check "SIG$signal on $ranks", sub {
    scene('long.prm', $impact, "$long & Output: Folder = long$ranks");
    if (!-d "long$ranks.whole")
    {
      runs(0, on($ranks, 'long.prm'));
      rename "long$ranks", "long$ranks.whole";
    }
    rmtree("long$ranks");
    my ($code, $text) = signalled($signal, "long$ranks/history.csv", on($ranks, 'long.prm'));
    my $found = is('exit code', $code, 5);
    return "$found\n$text" if $found ne '';
    my ($how) = $text =~ m{^billet: long.prm: stopped by SIG$signal at time \S+ after \d+ steps. To resume: billet (--restart \S+ \S+)$}m
      or return "says $text";
    runs(0, on($ranks, split / /, $how));
    return read_text("long$ranks/history.csv") eq read_text("long$ranks.whole/history.csv") ? '' : 'history.csv differs';
  };
}
check 'SIGUSR2 wants a checkpoint', sub {
  rmtree('long1');
  scene('long.prm', $impact, "$long & Output: Folder = long1");
  my ($code, $text) = signalled('USR2', 'long1/history.csv', on(1, 'long.prm'));
  return is('exit code', $code, 0) || is('checkpoints', join(' ', glob 'long1/*.h5'), 'long1/checkpoint_00000.h5');
};

# --- what is refused -------------------------------------------------------------------------------------------------

my $good = 'block1.whole/checkpoint_00002.h5';
sub spoiled
{
  my ($name, $change) = @_;
  my $bytes = read_text($good);
  $change->($bytes);
  write_text($name, $bytes);
  return $name;
}
mkdir 'folder.h5';
my @refused = (
  ['no such file', 'nowhere.h5', '', 'cannot be read; allowed is a checkpoint that is whole'],
  ['a folder', 'folder.h5', '', 'is a folder;'],
  ['a scene', 'block1.prm', '', 'is no checkpoint of billet;'],
  ['an empty file', spoiled('empty.h5', sub { $_[0] = '' }), '', 'is no checkpoint of billet;'],
  ['cut short', spoiled('short.h5', sub { $_[0] = substr $_[0], 0, length($_[0]) - 100 }), '', 'is cut short: \d+ of \d+ bytes are there;'],
  ['a flipped bit', spoiled('flipped.h5', sub { substr($_[0], length($_[0]) / 2, 1) ^= "\x10" }), '', 'is damaged: its checksum does not fit;'],
  ['another format', spoiled('format.h5', sub { $_[0] =~ s/format 7/format 9/ }), '', 'has format 9, this program reads format 7;'],
  ['another version', spoiled('version.h5', sub { $_[0] =~ s/program \d/program 7/ }), '', 'was written by billet 7\S+, this is billet \S+;'],
  ['another mesh', $good, 'Mesh: Arguments = 2, 2, 2 : 0, 0, 0 : 2, 1, 2 : true', "does not fit this scene: its body 'block' has 4 elements, here it has 8"],
  ['another shape', $good, 'Mesh: Arguments = 2, 1, 2 : 0, 0, 0 : 2, 1.1, 2 : true', "does not fit this scene: its body 'block' has another mesh"],
  ['another order', $good, 'Mesh: Positions = 2 - x ; 1 - y ; z', "does not fit this scene: its body 'block' has another mesh"],
  ['another law', $good, 'Material: Law = elastic & Material: - Hardening & Material: - Yield stress & Material: - Hardening modulus',
    "does not fit this scene: its body 'block' is elastoplastic with linear hardening, here it is elastic"],
  ['another name', $good, 'REWRITE block brick', "does not fit this scene: its body 1 is 'block', here it is 'brick'"],
  ['too late', $good, 'Time stepping: End time = 0.2', "found 'End time' = 0.2, allowed is a time after that of the checkpoint, \\S+"],
);
for my $case (@refused)
{
  my ($name, $file, $edits, $pattern) = @$case;
  check "refused: $name", sub {
    my $base = $block;
    if (my ($old, $new) = $edits =~ /^REWRITE (\S+) (\S+)$/)
    {
      $base =~ s/subsection $old\n/subsection $new\n/;
      $base =~ s/(Body +=) $old/$1 $new/;
      $edits = '';
    }
    scene('refused.prm', $base, 'Output: Folder = refused' . ($edits && " & $edits"));
    for my $ranks (1, @launcher ? 2 : ())
    {
      my ($code, $output, $errors) = run(on($ranks, '--restart', $file, 'refused.prm'));
      return "exit code $code on $ranks: $output$errors" unless $code == 2;
      return "says $errors" unless $errors =~ /^error\[bad-input\]: (command line: --restart: '\Q$file\E' |refused.prm: )$pattern.*\n\z/;
      return 'something was written' if -e 'refused';
    }
    return '';
  };
}
check 'refused by --check, too', sub {
  scene('refused.prm', $block, 'Output: Folder = refused & + subsection Restart\n set File = short.h5\nend');
  my ($code, $output, $errors) = run(on(1, '--check', 'refused.prm'));
  return is('exit code', $code, 2) || ($errors =~ /^error\[bad-input\]: refused.prm:\d+: 'File' in 'Restart': 'short.h5' is cut short/ ? '' : "says $errors");
};
check 'a pair with other partners', sub {
  my $other = $block;
  $other =~ s/subsection die\n/subsection stamp\n/;
  $other =~ s/(Tool +=) die/$1 stamp/;
  scene('refused.prm', $other, 'Output: Folder = refused');
  my ($code, $output, $errors) = run(on(1, '--restart', $good, 'refused.prm'));
  return is('exit code', $code, 2) || ($errors =~ /its contact pair 'top on die' joins body 'block' and tool 'die', here it joins body 'block' and tool 'stamp'; give/ ? '' : "says $errors");
};

# --- a full disk -----------------------------------------------------------------------------------------------------

# Where files may not become longer, writing fails as it does on a full disk. MPI's own files are to stay out of it.
for my $case ([16, 'none of it', ''], [700, 'a part of it', ' & Mesh: Arguments = 20, 10, 10 : 0, 0, 0 : 2, 1, 2 : true'])
{
  my ($limit, $name, $edits) = @$case;
  check "a disk that has room for $name", sub {
    scene('full.prm', $block, 'Output: Folder = full & Output: Format = none & Time stepping: End time = 0.2'
        . " & Time stepping: Largest step = 0.2$edits", 'set Every steps = 1');
    local $SIG{XFSZ} = 'IGNORE';
    local @ENV{'OMPI_MCA_btl', 'PMIX_MCA_gds'} = ('self', 'hash');
    my ($code, $output, $errors) = run('bash', '-c', "ulimit -f $limit; exec \"\$@\"", 'bash', on(1, 'full.prm'));
    my @left = glob 'full/checkpoint*';
    return is('exit code', $code, 0) || is('left', "@left", '')
      || ($output =~ m{^warning\[checkpoint-failed\]: No checkpoint was written: full/checkpoint_00000.h5.tmp cannot be made as long as it has to be: is the disk full\? \(time}m ? '' : "says $output");
  };
}
check 'a disk that becomes full', sub {
  scene('fuller.prm', $block, 'Output: Folder = fuller & Output: Format = none', 'set Every steps = 1');
  # A link to where nothing can be written takes the place of the third.
  mkdir 'fuller';
  symlink '/proc/nowhere', 'fuller/checkpoint_00002.h5.tmp';
  my ($code, $output, $errors) = run(on(1, 'fuller.prm'));
  return is('exit code', $code, 0)
    || ($output =~ m{^warning\[checkpoint-failed\]: No checkpoint was written: fuller/checkpoint_00002.h5.tmp cannot be made: is the disk full\? The last one, fuller/checkpoint_00001.h5, stays}m ? '' : "says $output");
};

print "$n_checks checks, $n_failed failed\n";
exit($n_checks && !$n_failed ? 0 : 1);
